#ifndef SHAPESPACE_BENCHMARKS_ARAP_H_
#define SHAPESPACE_BENCHMARKS_ARAP_H_

#include <vector>

#include <shapespace/deformation/handle.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::benchmarks {

/// The end shape of CGAL's `Surface_mesh_deformation` (SRE_ARAP: Sorkine and Alexa 2007 with the
/// smooth rotations of Levi and Gotsman 2015), with all vertices in its region. The handles move in
/// `steps` steps of `iterations` iterations each, which end early at a change of 1e-6.
Shape DeformByArap(const Connectivity& connectivity, const Shape& rest,
                   const std::vector<DeformationHandle>& handles, int steps, int iterations);

}  // namespace shapespace::benchmarks

#endif  // SHAPESPACE_BENCHMARKS_ARAP_H_
