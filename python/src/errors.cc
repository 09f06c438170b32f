#include <string>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/printable.h>
#include <shapespace/mesh/different_meshes.h>

#include "arrays.h"
#include "bind.h"

namespace shapespace::python {
namespace {

// The classes live as long as the interpreter.
PyObject* error = nullptr;
PyObject* file_error = nullptr;
PyObject* no_such_file = nullptr;
PyObject* file_not_permitted = nullptr;
PyObject* file_is_folder = nullptr;
PyObject* mesh_error = nullptr;
PyObject* mismatch_error = nullptr;
PyObject* invalid_options = nullptr;
PyObject* solver_error = nullptr;
PyObject* cancelled = nullptr;
PyObject* mesh_warning = nullptr;

PyObject* Make(py::module_* module, const char* name, const py::object& bases, const char* doc) {
  const std::string full = std::string("shapespace.") + name;
  PyObject* made = PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), nullptr);
  if (made == nullptr) throw py::error_already_set();
  module->add_object(name, made);
  return made;
}

// A message for Python's terminal.
std::string InPython(const std::string& text) {
  return internal::Printable(text, internal::kOfMessages);
}

py::object Class(PyObject* type) { return py::reinterpret_borrow<py::object>(type); }

std::string MessageOf(const Error& e) {
  return InPython(e.what() + (e.option().empty() ? "" : " (argument " + e.option() + ")"));
}

void Raise(PyObject* type, const Error& e) { PyErr_SetString(type, MessageOf(e).c_str()); }

// As what Python itself raises where the system refuses a file, with its number in `errno`.
void RaiseFileError(const FileError& e) {
  PyObject* type = file_error;
  if (e.cause() == std::errc::no_such_file_or_directory) type = no_such_file;
  if (e.cause() == std::errc::permission_denied) type = file_not_permitted;
  if (e.cause() == std::errc::is_a_directory) type = file_is_folder;
  const py::object made = Class(type)(MessageOf(e));
  if (e.cause()) made.attr("errno") = e.cause().value();
  PyErr_SetObject(type, made.ptr());
}

void Translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const RaisedInPython& raised) {
    raised.error->restore();
  } catch (const FileError& e) {
    RaiseFileError(e);
  } catch (const MeshError& e) {
    Raise(mesh_error, e);
  } catch (const DifferentMeshes& e) {
    PyErr_SetString(mismatch_error, InPython(e.MessageWith(kCorrespond)).c_str());
  } catch (const MismatchError& e) {
    Raise(mismatch_error, e);
  } catch (const InvalidOptions& e) {
    Raise(invalid_options, e);
  } catch (const SolverError& e) {
    Raise(solver_error, e);
  } catch (const Cancelled& e) {
    Raise(cancelled, e);
  } catch (const Error& e) {
    Raise(error, e);
  }
}

}  // namespace

void BindErrors(py::module_* module) {
  error =
      Make(module, "Error", Class(PyExc_Exception), "Base of everything that shapespace raises.");
  const auto with = [](PyObject* builtin) { return py::make_tuple(Class(error), Class(builtin)); };
  file_error = Make(module, "FileError", with(PyExc_OSError),
                    "A file cannot be opened, read to its end, understood or written.");
  const auto refused = [](PyObject* builtin) {
    return py::make_tuple(Class(file_error), Class(builtin));
  };
  no_such_file = Make(module, "NoSuchFile", refused(PyExc_FileNotFoundError),
                      "A file that is to be read is not there.");
  file_not_permitted = Make(module, "FileNotPermitted", refused(PyExc_PermissionError),
                            "The system does not permit to read or write a file.");
  file_is_folder = Make(module, "FileIsFolder", refused(PyExc_IsADirectoryError),
                        "A folder is named where a file should be.");
  mesh_error = Make(module, "MeshError", with(PyExc_ValueError), "A mesh cannot be used.");
  mismatch_error = Make(module, "MismatchError", with(PyExc_ValueError),
                        "Meshes that should be poses of one connectivity are not.");
  invalid_options =
      Make(module, "InvalidOptions", with(PyExc_ValueError),
           "An option has a value outside its range; the message begins with the option's name.");
  solver_error = Make(module, "SolverError", with(PyExc_RuntimeError),
                      "A solver cannot start or continue. If it only did not converge, its summary "
                      "says so and nothing is raised.");
  cancelled = Make(module, "Cancelled", Class(error),
                   "`progress` asked to stop before there was any result.");
  mesh_warning = Make(module, "MeshWarning", Class(PyExc_UserWarning),
                      "A mesh can be used, but should be checked.");
  py::register_exception_translator(Translate);
}

void Warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    py::module_::import("shapespace._warn").attr("warn")(InPython(warning), Class(mesh_warning));
  }
}

}  // namespace shapespace::python
