// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/contact/contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/errors.hpp"
#include "stage1_plate/contact/contact_system.hpp"

namespace fastjoint::stage1 {
namespace {

constexpr double at_rest = 1e-6;  // radians

/// Force on the disc of a hole from outside, as far as its directions tell.
Eigen::Vector2d disc_force(const PlateScene& scene, const Unknowns& unknowns, const Eigen::VectorXd& P, int hole) {
  Eigen::Vector2d force = Eigen::Vector2d::Zero();
  const int first = unknowns.disc_of_hole[hole];
  for (int a = 0; a < unknowns.n_directions; ++a)
    force += P[unknowns.controlled_of_disc(first + a)] * rim::axis(scene.disc_directions[a]);
  return force;
}

class ContactSearch {
 public:
  ContactSearch(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem)
      : scene_(scene), problem_(problem), system_(scene, plate, problem) {
    for (const int hole : system_.holes()) result_.push_back({hole, {}, 0, 0, 0, 0});
  }

  RimContactState run(int most_iterations) {
    start();
    for (int iteration = 1; !at_rest_; ++iteration) {
      if (iteration > most_iterations) not_converged(most_iterations);
      step(iteration);
    }
    state_ = system_.solve(arcs_);
    for (std::size_t i = 0; i < result_.size(); ++i) finish(i);
    return {std::move(result_), state_.displacement, state_.force, state_.friction, system_.traction()};
  }

 private:
  /// The bearing halves if the disc carries a force, else the whole rim.
  void start() {
    constexpr double carries = 1e-3;  // of the largest force anywhere
    const ContactSystem::State whole = system_.solve(std::vector(result_.size(), whole_rim));
    const double largest = std::max(whole.force.cwiseAbs().maxCoeff(), system_.traction().lpNorm<Eigen::Infinity>());
    for (std::size_t i = 0; i < result_.size(); ++i) {
      const Eigen::Vector2d force = disc_force(scene_, problem_.unknowns, whole.force, result_[i].hole);
      Arcs half;
      if (force.norm() > carries * largest) half = system_.gap(i).bearing_half(force.normalized());
      arcs_.push_back(half.empty() ? whole_rim : half);
    }
  }

  void step(int iteration) {
    state_ = system_.solve(arcs_);
    at_rest_ = state_.friction_settled;
    for (std::size_t i = 0; i < result_.size(); ++i) {
      Arcs next = system_.gap(i).pressed(state_.z);
      result_[i].last_move = largest_move(arcs_[i], next);
      result_[i].iterations = iteration;
      at_rest_ = at_rest_ && result_[i].last_move <= at_rest;
      arcs_[i] = std::move(next);
    }
  }

  [[noreturn]] void not_converged(int iterations) const {
    const auto& worst = *std::ranges::max_element(result_, {}, &RimContact::last_move);
    throw NumericalError(fmt::format(
        "{}: /holes/{}/spring: the contact of hole \"{}\" has not come to rest in {} iterations: {}; allowed: {:g} rad",
        scene_.file, worst.hole, scene_.holes[worst.hole].id, iterations,
        std::isfinite(worst.last_move) ? fmt::format("the ends of its arcs still move by {:.3g} rad", worst.last_move)
                                       : std::string("the number of its arcs still changes"),
        at_rest));
  }

  void finish(std::size_t i) {
    RimContact& contact = result_[i];
    const RimGap& gap = system_.gap(i);
    contact.arcs = arcs_[i];
    if (contact.arcs.empty()) return;
    const RimGap::Peak peak = gap.peak(state_.z);
    contact.peak_pressure = scene_.holes[contact.hole].sprung().modulus * peak.gap;
    contact.peak_angle = peak.angle;
    for (const auto& arc : contact.arcs)  // as the arc counts: 180 degrees at its end, not -180
      if (peak.angle < arc.from && peak.angle + rim::full_turn <= arc.to) contact.peak_angle += rim::full_turn;
    const Eigen::Vector2d force = disc_force(scene_, problem_.unknowns, state_.force, contact.hole);
    if (contact.arcs.size() == 1 && force.norm() > 0)
      contact.half_angle = half_angle(contact.arcs[0], std::atan2(force.y(), force.x()), gap.ends());
  }

  static double half_angle(const rim::AngleRange& arc, double bearing, const std::vector<double>& rim_ends) {
    constexpr double same = 1e-4 * rim::degree;
    const auto is = [&](double angle, double other) { return std::abs(rim::wrapped(angle - other)) < same; };
    if (is((arc.from + arc.to) / 2, bearing)) return (arc.to - arc.from) / 2;
    for (const double end : rim_ends)
      if (is(end, bearing) && (is(arc.from, end) || is(arc.to, end))) return arc.to - arc.from;
    return 0;
  }

  const PlateScene& scene_;
  const PlateProblem& problem_;
  ContactSystem system_;
  std::vector<RimContact> result_;
  std::vector<Arcs> arcs_;
  ContactSystem::State state_;
  bool at_rest_ = false;
};

}  // namespace

RimContactState find_contact(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem,
                             int most_iterations) {
  return ContactSearch(scene, plate, problem).run(most_iterations);
}

PlateScene with_arcs(PlateScene scene, const RimContactState& state) {
  for (const auto& contact : state.holes)
    if (auto& spring = scene.holes[contact.hole].spring) spring->acts = contact.arcs;
  return scene;
}

}  // namespace fastjoint::stage1
