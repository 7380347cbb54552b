// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/fit_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ostream>

#include "common/errors.hpp"
#include "common/h5/whole_file.hpp"
#include "common/program/program.hpp"
#include "stage3_nonlinear/fit_drawing.hpp"

namespace fastjoint::stage3 {
namespace {

Fit fitted(const FitOptions& options, const TestPoints& points) {
  try {
    return options.law == "power" ? fit_power(points) : fit_cubic(points);
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", options.data, e.what()));
  } catch (const NumericalError& e) {
    throw NumericalError(fmt::format("{}: {}", options.data, e.what()));
  }
}

std::string constants(const Fit& fit) {
  const auto plus_minus = [&](double sigma) { return fit.has_uncertainty ? fmt::format(" +- {:.2g}", sigma) : ""; };
  std::string text;
  if (fit.kind == Fit::Kind::power) {
    const std::array names{"A", "n", "delta0"};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      text += fmt::format("  {} = {:.6g}{}\n", names[i], fit.constants[k],
                          fit.on_bound[i] ? " (on its bound)" : plus_minus(std::sqrt(fit.covariance(k, k))));
    }
    return text;
  }
  for (const double delta : cubic_deltas(fit))
    text += fmt::format("  delta = {:.6g}: F = {:.6g}{}\n", delta, force(fit, delta),
                        plus_minus(force_uncertainty(fit, delta)));
  return text;
}

std::string json(const Fit& fit) {
  if (fit.kind == Fit::Kind::power)
    return fmt::format(R"({{"type": "power", "A": {:.10g}, "n": {:.10g}, "delta0": {:.10g}}})", fit.constants[0],
                       fit.constants[1], fit.constants[2]);
  const auto delta = cubic_deltas(fit);
  return fmt::format(R"({{"type": "cubic", "delta": [{:.10g}, {:.10g}, {:.10g}], "F": [{:.10g}, {:.10g}, {:.10g}]}})",
                     delta[0], delta[1], delta[2], force(fit, delta[0]), force(fit, delta[1]), force(fit, delta[2]));
}

}  // namespace

void run_fit(const FitOptions& options, std::ostream& out, std::ostream& log, program::Timings& timings) {
  if (options.law != "power" && options.law != "cubic")
    throw InputError(fmt::format("--law: '{}' is not allowed; allowed: power, cubic", options.law));
  timings.phase("read");
  const TestPoints points = read_points(options.data);
  timings.phase("solve");
  const Fit fit = fitted(options, points);
  for (const auto& sentence : fit.warnings)
    log << "stage3_nonlinear: warning: " << options.data << ": " << sentence << "\n";
  timings.phase("write");
  if (!options.drawing.empty()) h5::write_whole_file(options.drawing, drawing(fit, points));
  if (options.quiet) return;
  out << fmt::format("{} law fitted to {} points of {}; uncertainties are standard ones (1 sigma)\n", options.law,
                     fit.n_points, options.data)
      << constants(fit)
      << fmt::format(
             "  RMS residual of F: {:.4g}\n  F measured between sheets has their friction in it: fasteners with "
             "\"friction\" then take \"law_includes_friction\": true\nfor \"laws\" of a joint:\n"
             "  \"fitted\": {}\n",
             fit.rms, json(fit));
}

}  // namespace fastjoint::stage3
