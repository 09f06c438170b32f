#include <shapespace/geodesic/internal/workload.h>

#include <algorithm>
#include <cmath>

namespace shapespace::internal {

double Workload::Work(int vertices, int shapes, bool last) const {
  // Measured on bodies of 10 K to 40 K vertices: at a tolerance of 1e-4 all levels need the same
  // number of iterations, at 1e-6 the last level needs half as many again.
  const double accurate = last ? std::max(1.0, -std::log10(tolerance_) / 4) : 1;
  return accurate * vertices * shapes;
}

void Workload::Begin(const std::string& stage, int vertices, int shapes, bool last) {
  stage_ = stage;
  current_ = Work(vertices, shapes, last);
  energy_ = std::numeric_limits<double>::infinity();
  first_drop_ = share_ = 0;
}

bool Workload::GoOn(int iteration, double energy) {
  if (progress_ == nullptr || stopped_) return !stopped_;
  // Decreases of the energy fall from the first one to the tolerance, in L-BFGS more and more
  // slowly: measurements showed that when the logarithm has covered a share s of its range, s^2.5
  // of the iterations are done.
  const double drop = (energy_ - energy) / energy;
  energy_ = energy;
  if (std::isfinite(drop) && drop > 0) {
    first_drop_ = std::max(first_drop_, drop);
    const double way = std::log(first_drop_ / tolerance_);
    if (way > 0) {
      const double fallen = std::min(1.0, std::log(first_drop_ / drop) / way);
      share_ = std::max(share_, std::pow(fallen, 2.5));
    }
  }
  share_ = std::clamp(share_, static_cast<double>(iteration) / max_iterations_, 1.0);
  progress_->ReportShare(std::min(1.0, (done_ + share_ * current_) / planned_));
  stopped_ = !progress_->Report(stage_, iteration, 0);
  return !stopped_;
}

void Workload::End() { done_ += current_; }

}  // namespace shapespace::internal
