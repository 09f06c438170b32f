#ifndef SHAPESPACE_JAVASCRIPT_ARRAYS_H_
#define SHAPESPACE_JAVASCRIPT_ARRAYS_H_

#include <cstdint>
#include <string>
#include <vector>

#include <emscripten/val.h>

#include <shapespace/files/read.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/path/path.h>

// Values of JavaScript from and to those of the library. Positions are arrays x0, y0, z0, x1, ...

namespace shapespace::javascript {

using emscripten::val;

/// \throw InvalidOptions naming `name`: no array of numbers.
std::vector<double> ToNumbers(const val& numbers, const std::string& name);
/// \throw InvalidOptions naming `name`: no array of numbers, or not as many as 3 n.
Shape ToShape(const val& positions, const std::string& name);
std::vector<int> ToIntegers(const val& numbers, const std::string& name);

/// Poses from an array of objects, which are files, {name, data: Uint8Array}, or arrays,
/// {positions, indices}; indices may be left out but of the first. \throw as ReadPoses and
/// MakePoses.
Poses ToPoses(const val& poses, const ReadOptions& options);

/// A Float64Array.
val FromShape(const Shape& shape);
/// A Float64Array.
val FromNumbers(const std::vector<double>& numbers);
/// A Uint32Array with the corners of all triangles.
val IndicesOf(const Connectivity& connectivity);
/// Sentences and names of files, `WithoutFolder`.
val FromStrings(const std::vector<std::string>& strings);

/// {indices, shapes, times, poses, names, converged}: shapes as placed, in the user's unit.
val FromPath(const Path& path);

/// A sentence about a file by the name that it was given, without the folder in which it was
/// meanwhile.
std::string WithoutFolder(const std::string& sentence);

/// The content of a file, as a Uint8Array.
val FromBytes(const std::string& bytes);
std::string ToBytes(const val& bytes, const std::string& name);

}  // namespace shapespace::javascript

#endif  // SHAPESPACE_JAVASCRIPT_ARRAYS_H_
