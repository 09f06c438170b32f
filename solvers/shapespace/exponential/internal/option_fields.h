#ifndef SHAPESPACE_EXPONENTIAL_INTERNAL_OPTION_FIELDS_H_
#define SHAPESPACE_EXPONENTIAL_INTERNAL_OPTION_FIELDS_H_

#include <string>

#include <shapespace/exponential/correction.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/geodesic/internal/option_fields.h>

// The fields of options, and the words of enumerations (base/internal/fields.h).

namespace shapespace::internal {

inline Words<GeodesicIntegrator> WordsOf(Of<GeodesicIntegrator>) {
  return {{"variational", GeodesicIntegrator::kVariational},
          {"first_integral", GeodesicIntegrator::kFirstIntegral}};
}

inline Words<StepSolver> WordsOf(Of<StepSolver>) {
  return {{"newton_krylov", StepSolver::kNewtonKrylov}, {"ceres", StepSolver::kCeres}};
}

inline Words<FirstIntegralSolver> WordsOf(Of<FirstIntegralSolver>) {
  return {{"lbfgs", FirstIntegralSolver::kLbfgs},
          {"levenberg_marquardt", FirstIntegralSolver::kLevenbergMarquardt}};
}

inline Words<CorrectionMode> WordsOf(Of<CorrectionMode>) {
  return {{"proximal", CorrectionMode::kProximal}, {"paper", CorrectionMode::kPaper}};
}

inline Words<TransportConnection> WordsOf(Of<TransportConnection>) {
  return {{"levi_civita", TransportConnection::kLeviCivita},
          {"constrained_projection", TransportConnection::kConstrainedProjection}};
}

/// Those of the geodesic, but for the metric and the number of steps, which are arguments, and what
/// only a path has.
template <typename Visit>
void ForOptions(Of<LogarithmOptions>, const Visit& visit) {
  ForOptions(Of<GeodesicOptions>(), [&](const std::string& name, auto field, const char* about) {
    if (name != "metric" && name != "shapes" && name != "assess") visit(name.c_str(), field, about);
  });
}

template <typename Visit>
void ForOptions(Of<ExponentialOptions>, const Visit& visit) {
  visit("integrator", &ExponentialOptions::integrator,
        "The discrete Euler-Lagrange equation, or the paper's first integral, which does not "
        "converge.");
  visit("solver", &ExponentialOptions::solver,
        "What solves a step of the variational integrator; ceres is for small meshes.");
  visit("first_integral_solver", &ExponentialOptions::first_integral_solver,
        "What solves a step of the first integral; lbfgs is the paper's.");
  visit(
      "tolerance", &ExponentialOptions::tolerance,
      "A step is solved when its residual is less than this share of its value at velocity zero.");
  visit("max_iterations", &ExponentialOptions::max_iterations,
        "Iterations that a step may take, of Newton's method or of Ceres.");
  visit("stop_at_contact", &ExponentialOptions::stop_at_contact,
        "Whether the path ends before the first step in which parts of the body touch.");
  visit("slide_at_contact", &ExponentialOptions::slide_at_contact,
        "Whether parts of the body that would pass through each other slide along each other.");
}

template <typename Visit>
void ForOptions(Of<CorrectionOptions>, const Visit& visit) {
  visit("mode", &CorrectionOptions::mode,
        "Whether the distance from the given shapes has a cost; the paper's mode collapses.");
  visit("mu", &CorrectionOptions::mu,
        "Weight of that distance: small values keep lengths, large ones motion.");
  visit("tolerance", &CorrectionOptions::tolerance,
        "Done when an iteration lowers what is minimised by less than this share of it.");
  visit("max_iterations", &CorrectionOptions::max_iterations,
        "Reaching it is reported as not converged.");
}

template <typename Visit>
void ForOptions(Of<TransportOptions>, const Visit& visit) {
  visit("connection", &TransportOptions::connection,
        "The metric's own connection, or the paper's.");
  visit("align", &TransportOptions::align,
        "Turn each shape onto the next one, and the tangent with it, before a step.");
  visit("tolerance", &TransportOptions::tolerance,
        "Error of a step's linear systems, as a share of the tangent's norm.");
  visit("max_iterations", &TransportOptions::max_iterations,
        "Of the linear solver, a step and tangent.");
  visit("memory_limit", &TransportOptions::memory_limit,
        "Bytes that the call may take; an estimate above it is refused at once.");
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPONENTIAL_INTERNAL_OPTION_FIELDS_H_
