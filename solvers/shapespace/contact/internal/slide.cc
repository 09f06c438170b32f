#include <shapespace/contact/internal/slide.h>

#include <shapespace/contact/internal/avoid_contact.h>
#include <shapespace/contact/internal/follow.h>
#include <shapespace/minimise/internal/preconditioner.h>

namespace shapespace::internal {

SlideResult SlideAtContact(const std::shared_ptr<const Metric>& metric, Progress* progress,
                           std::vector<Shape>* path) {
  std::vector<Shape>& shapes = *path;
  const ContactModel model(metric, {shapes.front()}, ContactModel::Intersections::kExempt);
  SlideResult result;
  if (SegmentsWithContact(model, shapes).empty()) return result;
  if (model.NumIntersections() > 0) {
    result.warnings.push_back(WarningOfIntersections("the first shape intersects itself", model));
  }
  const CholeskyFactor<float> factor(ScalarMetric(*metric, {shapes.front(), shapes.back()}, 0));
  const Attraction attraction = {metric, factor, kCloseApproach};
  const double stiffness = kContactStiffness * EnergyAlong(*metric, shapes);
  const FreeWay way = Follow(model, attraction, stiffness, shapes, [&] {
    ReportProgress(progress, "sliding past contacts", 0, 0);
    return true;
  });
  for (size_t i = 0; i < shapes.size(); ++i) shapes[i] = way.shapes[way.reached[i]];
  result.uncertified_segments = static_cast<int>(SegmentsWithContact(model, shapes).size());
  if (result.uncertified_segments > 0) {
    result.warnings.push_back(WarningOfUncertified(result.uncertified_segments));
  }
  result.contact_distance = LeastDistance(model, shapes);
  return result;
}

}  // namespace shapespace::internal
