#include <shapespace/correspondence/correspondence_page.h>

#include <Eigen/Eigenvalues>

#include <shapespace/base/error.h>
#include <shapespace/mesh/rigid_motion.h>

namespace shapespace {
namespace {

// Red, green and blue from the position along the three principal axes of the vertices, each from
// end to end, so that no two places far from each other have the same colour.
Eigen::MatrixXd ColoursByPlace(const Shape& shape) {
  constexpr double kDarkest = 0.1, kBrightest = 0.95;
  const Shape centred = shape.colwise() - shape.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(centred * centred.transpose());
  Eigen::MatrixXd colours = axes.eigenvectors().transpose() * centred;
  for (int k = 0; k < 3; ++k) {
    const double least = colours.row(k).minCoeff(), most = colours.row(k).maxCoeff();
    if (!(most > least)) {
      colours.row(k).setConstant(kDarkest);
      continue;
    }
    colours.row(k) =
        kDarkest + (kBrightest - kDarkest) / (most - least) * (colours.row(k).array() - least);
  }
  return colours;
}

}  // namespace

std::array<PageMesh, 2> PageOf(const std::shared_ptr<const Connectivity>& template_connectivity,
                               const Shape& template_shape, const std::string& template_name,
                               const std::shared_ptr<const Connectivity>& target_connectivity,
                               const Shape& target_shape, const std::string& target_name,
                               const CorrespondenceResult& result) {
  if (template_shape.cols() != result.fitted.cols() ||
      target_shape.cols() != result.map.to_template.NumVertices()) {
    throw MeshError("the meshes are not those of the correspondence");
  }
  const Shape scaled = result.summary.scale * template_shape;
  const RigidMotion turn =
      FitRigidMotion(scaled, result.fitted, Eigen::VectorXd::Ones(scaled.cols()));
  const Eigen::MatrixXd colours = ColoursByPlace(template_shape);
  PageMesh source{template_connectivity, turn(scaled), colours, template_name};
  PageMesh target{target_connectivity, target_shape,
                  PullBack(result.map.to_template, template_connectivity->Triangles(), colours),
                  target_name};
  for (const CorrespondenceMarker& marker : result.markers) {
    source.markers.push_back(marker.template_vertex);
    target.markers.push_back(marker.target_vertex);
  }
  return {source, target};
}

}  // namespace shapespace
