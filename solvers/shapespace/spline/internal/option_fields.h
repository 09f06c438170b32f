#ifndef SHAPESPACE_SPLINE_INTERNAL_OPTION_FIELDS_H_
#define SHAPESPACE_SPLINE_INTERNAL_OPTION_FIELDS_H_

#include <functional>

#include <shapespace/geodesic/internal/option_fields.h>
#include <shapespace/spline/spline.h>

// The fields of options, and the words of enumerations (base/internal/fields.h).

namespace shapespace::internal {

inline Words<SplineEnds> WordsOf(Of<SplineEnds>) {
  return {{"natural", SplineEnds::kNatural},
          {"clamped", SplineEnds::kClamped},
          {"not_a_knot", SplineEnds::kNotAKnot},
          {"periodic", SplineEnds::kPeriodic}};
}

template <typename Visit>
void ForOptions(Of<SplineOptions>, const Visit& visit) {
  visit("ends", &SplineOptions::ends,
        "What determines the velocity at the ends: no acceleration there; given velocities; the "
        "first two intervals being one cubic, and the last two; or the motion that goes on from "
        "the last pose to the first.");
  visit("times", &SplineOptions::times,
        "When the poses are met, in ascending order and any unit; for periodic splines one more "
        "than there are poses. None: evenly spaced.");
  visit("by_length", &SplineOptions::by_length,
        "Without times, the time between two poses is in proportion to the length of the geodesic "
        "between them, so that the mean speed is the same everywhere.");
  visit("first_velocity", &SplineOptions::first_velocity,
        "Of the vertices, for clamped ends, per unit of time; without times, per interval.");
  visit("last_velocity", &SplineOptions::last_velocity, "Likewise, at the last pose.");
  visit("hold_limit", &SplineOptions::hold_limit,
        "Velocities at a pose are at most this number times the slower mean velocity beside it, so "
        "that a pose that is held is held; 0: no limit.");
  ForOptionsOfPart(&SplineOptions::geodesic, visit);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPLINE_INTERNAL_OPTION_FIELDS_H_
