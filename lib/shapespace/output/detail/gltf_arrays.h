#ifndef SHAPESPACE_OUTPUT_DETAIL_GLTF_ARRAYS_H_
#define SHAPESPACE_OUTPUT_DETAIL_GLTF_ARRAYS_H_

#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include <shapespace/files/internal/tinygltf.h>

// The only buffer of a glTF file, and accessors of it.

namespace shapespace::internal {

constexpr int ComponentType(uint8_t) { return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE; }
constexpr int ComponentType(uint16_t) { return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT; }
constexpr int ComponentType(uint32_t) { return TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT; }
constexpr int ComponentType(float) { return TINYGLTF_COMPONENT_TYPE_FLOAT; }

/// Appends bytes to the model's buffer and returns their view.
inline int AddBytes(const void* data, size_t size, int target, tinygltf::Model* model) {
  std::vector<unsigned char>& bytes = model->buffers[0].data;
  bytes.resize((bytes.size() + 3) / 4 * 4);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = bytes.size();
  view.byteLength = size;
  view.target = target;
  const auto* const begin = static_cast<const unsigned char*>(data);
  bytes.insert(bytes.end(), begin, begin + size);
  model->bufferViews.push_back(view);
  return static_cast<int>(model->bufferViews.size()) - 1;
}

/// Appends numbers, or vectors, to the model's buffer and returns their accessor.
template <typename Array>
int Add(const Array& array, int type, int target, tinygltf::Model* model) {
  using Scalar = typename Array::Scalar;
  tinygltf::Accessor accessor;
  accessor.bufferView = AddBytes(array.data(), array.size() * sizeof(Scalar), target, model);
  accessor.componentType = ComponentType(Scalar());
  accessor.type = type;
  accessor.count = array.size() / tinygltf::GetNumComponentsInType(type);
  model->accessors.push_back(accessor);
  return static_cast<int>(model->accessors.size()) - 1;
}

/// The same with the bounds that the format requires for positions and times.
template <typename Array>
int AddWithBounds(const Array& array, int type, int target, tinygltf::Model* model) {
  const int index = Add(array, type, target, model);
  for (Eigen::Index r = 0; r < array.rows(); ++r) {
    model->accessors[index].minValues.push_back(array.row(r).minCoeff());
    model->accessors[index].maxValues.push_back(array.row(r).maxCoeff());
  }
  return index;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_GLTF_ARRAYS_H_
