#ifndef SHAPESPACE_EXPLORATION_INTERNAL_OPTION_FIELDS_H_
#define SHAPESPACE_EXPLORATION_INTERNAL_OPTION_FIELDS_H_

#include <shapespace/exploration/embedding.h>
#include <shapespace/exploration/explore.h>
#include <shapespace/geodesic/internal/option_fields.h>

// The fields of options, and the words of enumerations (base/internal/fields.h).

namespace shapespace::internal {

template <typename Visit>
void ForOptions(Of<EmbeddingOptions>, const Visit& visit) {
  visit("tolerance", &EmbeddingOptions::tolerance,
        "Ends when an iteration lowers the stress by less than this share of it.");
  visit("max_iterations", &EmbeddingOptions::max_iterations, "Iterations that it may take.");
}

template <typename Visit>
void ForOptions(Of<ExploreOptions>, const Visit& visit) {
  visit("geodesic", &ExploreOptions::geodesic,
        "Of every geodesic; its number of shapes must be odd.");
  visit("resolution", &ExploreOptions::resolution,
        "Triangles, at most, of the decimated mesh on which distances and errors are measured; 0: "
        "the mesh itself.");
  visit("threshold", &ExploreOptions::threshold,
        "A straight line between two nodes that is longer than the geodesic by more than this "
        "share is replaced by two.");
  visit("depth", &ExploreOptions::depth,
        "How often a triangle of the plane may be split, at most.");
  visit("embedding", &ExploreOptions::embedding, "Of the places on the plane.");
  visit("records", &ExploreOptions::records,
        "A folder in which finished geodesics are kept, to go on from if a run is ended; empty: "
        "nothing is kept.");
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPLORATION_INTERNAL_OPTION_FIELDS_H_
