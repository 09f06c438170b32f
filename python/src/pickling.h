#ifndef SHAPESPACE_PYTHON_PICKLING_H_
#define SHAPESPACE_PYTHON_PICKLING_H_

#include <pybind11/pybind11.h>

namespace shapespace::python {

namespace py = pybind11;

/// All of an object as bytes, in the layout of the library's files; folders of material libraries
/// are absolute. For Path, PoseSpace, PoseModes, Poses and FrozenMetric.
template <typename T>
py::bytes Pack(const T& value);

/// What `Pack` has packed. \throw FileError if another version of the library has.
template <typename T>
T Unpack(const py::bytes& bytes);

/// How objects of a class are copied to other processes, for `py::class_::def`.
template <typename T>
auto Pickle() {
  return py::pickle(&Pack<T>, &Unpack<T>);
}

}  // namespace shapespace::python

#endif  // SHAPESPACE_PYTHON_PICKLING_H_
