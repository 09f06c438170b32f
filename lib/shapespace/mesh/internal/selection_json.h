#ifndef SHAPESPACE_MESH_INTERNAL_SELECTION_JSON_H_
#define SHAPESPACE_MESH_INTERNAL_SELECTION_JSON_H_

#include <string>

#include <shapespace/base/internal/json.h>
#include <shapespace/mesh/selection.h>

// The text form of selections, which is also a component of other JSON.

namespace shapespace::internal {

/// \throw InvalidOptions naming the field.
Selection ParseSelection(const Json& json);

/// The field name of selection `i`, counted from 0, in `field`'s `any`.
std::string FieldOfAny(const std::string& field, size_t i);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_INTERNAL_SELECTION_JSON_H_
