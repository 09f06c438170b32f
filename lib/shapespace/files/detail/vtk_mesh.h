#ifndef SHAPESPACE_FILES_DETAIL_VTK_MESH_H_
#define SHAPESPACE_FILES_DETAIL_VTK_MESH_H_

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/files/detail/number_type.h>
#include <shapespace/mesh/soup.h>

namespace shapespace::internal {

/// A mesh that is put together from the arrays of a VTK file, legacy or XML. Points, cells and data
/// of points come in this order, once or, for a file of several pieces, once for each piece.
class VtkMesh {
 public:
  enum class Cells { kVertices, kLines, kPolygons, kStrips };
  /// What an array of point data is used for.
  enum class Use { kNone, kColours, kTexture, kField };
  /// A name of an array, and what its numbers are.
  struct Array {
    std::string name;
    NumberType type = NumberType::kDouble;
    int components = 1;
    bool is_texture = false;  ///< the format declares it as texture coordinates
    bool is_colour = false;   ///< the format declares it as colours
  };

  /// `field` is the array of point data that is wanted instead of the mesh; empty for the mesh.
  VtkMesh(const std::string& file, std::string field) : field_name_(std::move(field)) {
    soup_.file = file;
  }

  /// Begins a piece. \throw FileError if they are not triples of finite numbers.
  void AddPoints(const std::vector<double>& numbers);

  /// Points of the current piece.
  size_t NumPiecePoints() const { return points_.size() / 3 - piece_begin_; }

  /// Cells of one kind: cell i has the points between ends[i - 1], or 0, and ends[i] of
  /// `connectivity`, counted from 0 in the piece. Strips become triangles, lines segments.
  /// \throw FileError naming the cell: too few points, an index or an end out of range.
  void AddCells(Cells kind, const std::vector<double>& connectivity,
                const std::vector<double>& ends);

  /// The same, with a kind for each cell.
  void AddCells(const std::vector<Cells>& kinds, const std::vector<double>& connectivity,
                const std::vector<double>& ends);

  /// What `AddPointData` would do with this array; unless anything, it is remembered as not kept.
  /// \throw FileError if it is the wanted field and has several components.
  Use UseOf(const Array& array);

  /// Data of the piece's points. \throw FileError if their number does not fit and they are the
  /// wanted field; others are dropped then.
  void AddPointData(const Array& array, Use use, const std::vector<double>& numbers);

  /// Remembers a sentence about what is not kept.
  void Drop(const std::string& what) { soup_.dropped.push_back(what); }

  Soup TakeSoup();

  /// The wanted field. \throw FileError if not all points have it.
  Eigen::VectorXd TakeField();

 private:
  [[noreturn]] void Fail(const std::string& what) const;
  void AddCell(Cells kind, const double* begin, const double* end);
  int Index(double number, const char* kind, size_t cell) const;
  void TakeColours();

  Soup soup_;
  std::string field_name_;
  std::vector<double> points_;  // three numbers for each
  size_t piece_begin_ = 0;      // the first point of the piece
  std::vector<double> colours_, texture_, field_;
  int channels_ = 0;          // of colours
  double full_colour_ = 255;  // the number that stands for full colour
  size_t vertex_cells_ = 0, lines_ = 0, strips_ = 0;
  std::vector<std::string> not_kept_;  // names of point data, each once
  std::set<std::string> not_kept_names_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_FILES_DETAIL_VTK_MESH_H_
