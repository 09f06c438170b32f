#ifndef SHAPESPACE_BODIES_MIURA_H_
#define SHAPESPACE_BODIES_MIURA_H_

#include <shapespace/bodies/body.h>

namespace shapespace {

/// A Miura fold: nx x ny parallelograms with sides `a` (along y, the direction of the zigzags) and
/// `b` (along x) that meet at the acute angle `corner` in degrees, as polygons of four corners.
/// Rigidly foldable: every parallelogram stays planar and keeps its sides and both diagonals while
/// `pose(angle)` folds all of them; `angle`, in degrees, is that between a parallelogram and the xy
/// plane, from 0, the flat sheet, to 85; at 90 all would coincide. M. Schenk, S. D. Guest,
/// "Geometry of Miura-folded metamaterials", PNAS 2013, equations 1 to 4.
/// \throw InvalidOptions if a length is not positive and finite, the corner is not in [10, 80], a
///        count is below 1, or there would be more than 20 million triangles.
ShapeFamily MakeMiura(double a, double b, double corner, int nx, int ny);

}  // namespace shapespace

#endif  // SHAPESPACE_BODIES_MIURA_H_
