// SPDX-License-Identifier: GPL-3.0-or-later
// Solvers over random joints.
//   stability check JOINTS [MAX_ITERATIONS]   what is promised: a table, and status 1 if a promise is broken
//   stability chart JOINTS                    every solver, coordinate and first guess, as CSV
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iostream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "stage3_nonlinear/solvers/root.hpp"
#include "tests/bench/gsl_methods.hpp"
#include "tests/bench/stability_falling.hpp"
#include "tests/bench/stability_friction.hpp"
#include "tests/bench/stability_trial.hpp"

namespace {

using namespace fastjoint;
using namespace fastjoint::bench;
using stage3::RootOptions;

constexpr double tolerance = 1e-10, agreement = 1e-8;
/// Joints at which damped Newton failed once: sheets that fly far through their gaps, forces next to nothing beside
/// a corner, springs as weak as the trace of stiffness.
constexpr std::array<std::uint32_t, 12> hard_seeds{2239,  6481,  6799,   9040,   9423,   9669,
                                                   11773, 16060, 111403, 126010, 135656, 154916};

std::vector<std::uint32_t> seeds(int n) {
  std::vector<std::uint32_t> result(hard_seeds.begin(), hard_seeds.end());
  for (std::uint32_t seed = 0; static_cast<int>(result.size()) < n; ++seed)
    if (std::find(hard_seeds.begin(), hard_seeds.end(), seed) == hard_seeds.end()) result.push_back(seed);
  return result;
}

std::string name(const RandomJoint& joint) {
  return fmt::format("seed {}: {}, {} planes, stiffness ratio {:.1e}", joint.seed,
                     family_names[static_cast<std::size_t>(joint.family)], joint.equations.contacts.size(),
                     joint.ratio);
}

/// Keeps what is promised of damped Newton and of the program.
class Promises {
 public:
  explicit Promises(const RootOptions& options) : options_(options) {}

  void check(const RandomJoint& joint) {
    const bool friction = joint.equations.has_friction;
    auto trials = try_guesses(joint, stage3::newton_root, Coordinate::contact, options_);
    auto& iterations = iterations_[joint.family];
    for (const auto& trial : trials) {
      iterations.push_back(trial.iterations);
      if (!friction && !trial.solved) complain(joint, "damped Newton does not converge");
    }
    trials.push_back(try_as_shipped(joint, options_));
    if (!trials.back().solved) complain(joint, "the program does not converge");
    if (!friction) compare(joint, trials);
  }

  void complain(const std::string& sentence) {
    std::cout << sentence << "\n";
    ++broken_;
  }

  /// False if a promise was broken.
  bool summary() {
    std::cout << "iterations of damped Newton: family, tries, median, worst\n";
    for (auto& [family, all] : iterations_) {
      std::sort(all.begin(), all.end());
      std::cout << fmt::format("{:22} {:6} {:4} {:4}\n", family_names[static_cast<std::size_t>(family)], all.size(),
                               all[all.size() / 2], all.back());
    }
    std::cout << fmt::format("largest difference of forces: {:.1e}; promises broken: {}\n", apart_, broken_);
    return broken_ == 0;
  }

 private:
  void complain(const RandomJoint& joint, const char* what) { complain(fmt::format("{}: {}", name(joint), what)); }

  /// Without friction the forces are unique (docs/theory.md, section 8.3).
  void compare(const RandomJoint& joint, const std::vector<Trial>& trials) {
    Eigen::VectorXd first = joint.exact;
    for (const auto& trial : trials) {
      if (!trial.solved) continue;
      if (first.size() == 0) first = trial.F;
      const double largest = std::max(first.cwiseAbs().maxCoeff(), joint.force_scale());
      const double apart = (trial.F - first).cwiseAbs().maxCoeff() / largest;
      apart_ = std::max(apart_, apart);
      if (!(apart <= agreement)) complain(joint, "solutions differ");
    }
  }

  RootOptions options_;
  std::map<Family, std::vector<int>> iterations_;
  double apart_ = 0;
  int broken_ = 0;
};

bool check(int n, const RootOptions& options) {
  Promises promises(options);
  for (const auto seed : seeds(n)) promises.check(random_joint(seed));
  const Falling falling = check_falling(n / 10, tolerance);
  for (const auto& sentence : falling.broken) promises.complain(sentence);
  if (falling.joints >= 100 && 10 * falling.several < falling.joints)
    promises.complain("laws that fall: too few joints with several solutions to show anything");
  std::cout << fmt::format("laws that fall: {} joints, {} solved, {} with several solutions, {} warned of\n",
                           falling.joints, falling.solved, falling.several, falling.warned);
  return promises.summary();
}

void print(const RandomJoint& joint, const char* solver, const char* coordinate, const std::vector<Trial>& trials) {
  for (std::size_t guess = 0; guess < trials.size(); ++guess) {
    const Trial& t = trials[guess];
    std::cout << fmt::format("{},{},{},{:.3g},{},{},{},{:d},{},{},{},{:.3g}\n", joint.seed,
                             family_names[static_cast<std::size_t>(joint.family)], joint.equations.contacts.size(),
                             joint.ratio, solver, coordinate, guess, t.solved, t.iterations, t.residuals, t.jacobians,
                             t.seconds);
  }
}

void chart(int n, const RootOptions& options) {
  std::cout << "seed,family,planes,ratio,solver,coordinate,guess,solved,iterations,residuals,jacobians,seconds\n";
  for (const auto seed : seeds(n)) {
    const RandomJoint joint = random_joint(seed);
    for (const auto coordinate : {Coordinate::contact, Coordinate::displacement})
      for (const auto& solver : solvers())
        print(joint, solver.name, coordinate_names[static_cast<std::size_t>(coordinate)],
              try_guesses(joint, solver.solve, coordinate, options));
    print(joint, "as shipped", coordinate_names[0], {try_as_shipped(joint, options)});
  }
}

int number(const char* text) {
  const std::string_view all(text);
  int value = 0;
  const auto [end, error] = std::from_chars(all.data(), all.data() + all.size(), value);
  return error == std::errc() && end == all.data() + all.size() ? value : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<const char*> arguments(argv + 1, argv + argc);
  const bool given = arguments.size() == 2 || arguments.size() == 3;
  const std::string task = given ? arguments[0] : "";
  const int n = given ? number(arguments[1]) : 0;
  const RootOptions options{tolerance, arguments.size() == 3 ? number(arguments[2]) : 200};
  if ((task != "check" && task != "chart" && task != "friction") || n < 1 || options.max_iterations < 1) {
    std::cerr << "usage: stability check|chart|friction JOINTS [MAX_ITERATIONS]\n";
    return 2;
  }
  stage3::take_over_gsl_errors();
  if (task == "friction") return chart_friction(n) ? 0 : 1;
  if (task == "check") return check(n, options) ? 0 : 1;
  chart(n, options);
  return 0;
}
