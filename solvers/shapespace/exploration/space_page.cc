#include <shapespace/exploration/space_page.h>

namespace shapespace {

PageSpace PageOf(const PoseSpace& space, const std::string& name) {
  PageSpace page;
  page.connectivity = space.metric->connectivity;
  for (int i = 0; i < space.NumNodes(); ++i) page.nodes.push_back(space.Placed(i));
  page.names = space.names;
  page.points = space.points;
  page.triangles = space.triangles;
  page.segments = space.segments;
  page.parents = space.parents;
  page.vertex_colours = space.appearance.vertex_colours;
  page.name = name;
  return page;
}

}  // namespace shapespace
