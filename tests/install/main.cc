#include <iostream>

#include <shapespace/bodies/body.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/output/picture.h>

int main() {
  const shapespace::ShapeFamily tube = shapespace::MakeBody("tube");
  const auto [path, summary] =
      shapespace::Interpolate(tube.connectivity, {tube.pose(0), tube.pose(110)});
  std::cout << summary.FullReport();
  shapespace::WritePng("tube.png", shapespace::RenderFilmStrip(*tube.connectivity, path.Placed()));
}
