#ifndef SHAPESPACE_SKINNING_INTERNAL_OPTION_FIELDS_H_
#define SHAPESPACE_SKINNING_INTERNAL_OPTION_FIELDS_H_

#include <shapespace/base/internal/fields.h>
#include <shapespace/skinning/skinning.h>

// The fields of options (base/internal/fields.h).

namespace shapespace::internal {

template <typename Visit>
void ForOptions(Of<SkinningOptions>, const Visit& visit) {
  visit("bones", &SkinningOptions::bones,
        "Number of bones; 0: as few as are found with which the error is at most `error`.");
  visit("error", &SkinningOptions::error,
        "Where the number is to be found: the permitted root mean square distance of vertices from "
        "their places, as a share of half the diagonal of the rest pose.");
  visit("most_bones", &SkinningOptions::most_bones,
        "Where the number is to be found: no more than these.");
  visit("weights_per_vertex", &SkinningOptions::weights_per_vertex,
        "Bones that may move a vertex, 1 to 8; engines read 4.");
  visit("scale", &SkinningOptions::scale,
        "Whether bones may also be stretched along their own axes; not every engine plays it.");
  visit("rest", &SkinningOptions::rest,
        "The shape of the path that is the rest pose, counted from 0.");
  visit("tolerance", &SkinningOptions::tolerance,
        "An iteration that lowers the error by less than this share of it is the last.");
  visit("max_iterations", &SkinningOptions::max_iterations,
        "Fits of weights and motions, in turn.");
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SKINNING_INTERNAL_OPTION_FIELDS_H_
