// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/stability_joints.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tests/bench/stability_curves.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::bench {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using stage3::Contact;
using test::ground;
using test::Spring;

/// A row of n discs between springs of about k.
struct Row {
  int n;
  double k;
  bool loaded = false;  ///< external "P" at its end
  double held = 0;      ///< spring to the ground at its beginning
};

formats::PlateMatrices plate(std::mt19937& random, const Row& row) {
  std::vector<Spring> springs;
  for (int i = 0; i + 1 < row.n; ++i) springs.push_back({i, i + 1, row.k * decades(random, 0.3, 3)});
  if (row.loaded) springs.push_back({row.n - 1, row.n, row.k});
  if (row.held > 0) springs.push_back({0, ground, row.held});
  return test::spring_plate(row.n, row.loaded ? 1 : 0, springs);
}

test::Lap rows(std::mt19937& random, Family family, int n) {
  const double k = decades(random, 1e2, 1e7);
  Row a{n, k, true}, b{n, k * decades(random, 0.1, 10)};
  switch (family) {
    case Family::doubler:
      a.held = k;
      break;
    case Family::weak: {
      const double weak = decades(random, 1e-10, 1e-6);
      if (chance(random, 0.5)) {  // pulled at a, or stretched under b
        a.held = weak * k;
        b.held = b.k;
      } else {
        a.held = k;
        b.held = weak * b.k;
      }
      break;
    }
    default:
      a.held = chance(random, 0.5) ? k * decades(random, 0.01, 1) : 0;
      b.held = b.k;
  }
  return {plate(random, a), plate(random, b), decades(random, 1e-3, 1e6)};
}

/// A joint whose laws are still to come: of plates, or of a stiffness and a load alone.
struct Base {
  std::optional<test::HandMade> joint;
  MatrixXd S_ud;
  VectorXd q;

  /// @param contacts One for each plane; without plates with the plates' own stiffness.
  [[nodiscard]] stage3::JointEquations with(const std::vector<Contact>& contacts) const {
    if (!joint) return test::equations_of(S_ud, q, contacts);
    test::HandMade its = *joint;
    for (Index j = 0; j < std::ssize(contacts); ++j) {
      its.law[j] = contacts[j].law;
      its.clearance[j] = contacts[j].clearance;
      its.planes[j].one_sided = contacts[j].one_sided;
    }
    return make_equations(its);
  }
};

Base base_of(test::HandMade joint) {
  const auto equations = make_equations(joint);
  return {std::move(joint), equations.system->S_ud, equations.q};
}

Base two_plates(std::mt19937& random, Family family, int n) {
  auto lap = rows(random, family, n);
  const bool friction = family == Family::friction;
  if (friction) {
    test::add_friction(lap.a, random);
    test::add_friction(lap.b, random);
  }
  auto joint = test::joint_of(lap, test::linear_law(1));
  for (Index j = 0; friction && j < std::ssize(joint.planes); ++j)
    if (chance(random, 0.7)) test::set_friction(joint, j, uniform(random, 0, 0.4));
  return base_of(std::move(joint));
}

Base three_plates(std::mt19937& random, int n_planes) {
  const int n = std::max(2, n_planes / 2);
  const double k = decades(random, 1e2, 1e7);
  const auto law = test::linear_law(1);
  auto joint = test::joint_of({plate(random, {n, k, true, chance(random, 0.5) ? k : 0}),
                               plate(random, {n, k * decades(random, 0.1, 10), false, k}), decades(random, 1e-3, 1e6)},
                              law);
  joint.remove_fasteners();
  joint.plates.push_back(stage3::make_plate(
      "c", "c.h5", plate(random, {n, k * decades(random, 0.1, 10), false, chance(random, 0.5) ? k : 0}), 8));
  for (int j = 0; j < n; ++j) test::add_fastener(joint, {{1, j}, {0, j}, {2, j}}, law);
  return base_of(std::move(joint));
}

/// Eigenvalues over three decades, in one joint of two a plate that floats in x and y.
Base discs_in_x_and_y(std::mt19937& random, int n_planes) {
  const Index n = 2 * std::max(2, n_planes / 2);
  const auto normal = [&] { return std::normal_distribution<double>()(random); };
  const Eigen::HouseholderQR<MatrixXd> qr(MatrixXd::NullaryExpr(n, n, normal));
  const MatrixXd Q = qr.householderQ();
  const double k = decades(random, 1e2, 1e7);
  const VectorXd values = VectorXd::NullaryExpr(n, [&] { return k * decades(random, 1e-3, 1); });
  Base system;
  system.S_ud = Q * values.asDiagonal() * Q.transpose();
  if (chance(random, 0.5)) {
    MatrixXd fixed = MatrixXd::Zero(n, n);  // what is left without the mean motion in each direction
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j)
        fixed(i, j) = (i == j ? 1 : 0) - ((i - j) % 2 == 0 ? 2.0 / static_cast<double>(n) : 0);
    system.S_ud = fixed * system.S_ud * fixed;
  }
  system.q = decades(random, 1e-3, 1e6) * VectorXd::NullaryExpr(n, normal);
  return system;
}

Base random_base(std::mt19937& random, Family family, int n_planes) {
  if (family == Family::stack) return three_plates(random, n_planes);
  if (family == Family::discs) return discs_in_x_and_y(random, n_planes);
  return two_plates(random, family, n_planes);
}

/// Makes the load from a solution: coordinates at random, of which some stop exactly where a fastener begins to bear,
/// slips or yields. Then there is a solution also of fasteners that carry a limited force only.
void load_from_solution(std::mt19937& random, const Base& base, std::vector<Contact>& contacts, RandomJoint& joint) {
  const Index a = std::ssize(base.q) / contacts.size();
  const double scale = base.q.cwiseAbs().maxCoeff();
  VectorXd c = VectorXd::NullaryExpr(
      base.q.size(), [&] { return scale * (chance(random, 0.5) ? 1 : -1) * decades(random, 1e-2, 10); });
  for (Index j = 0; j < std::ssize(contacts); ++j) {
    const Contact& contact = joint.equations.contacts[j];
    auto here = c.segment(j * a, a);
    const double open = contact.stiffness * contact.law->gap(contact.clearance);
    here += here.normalized() * open;
    if (joint.family != Family::contact || chance(random, 0.3)) continue;
    const auto corners = contact.law->corners(contact.stiffness, contact.clearance);
    const double event = corners && !corners->empty() ? corners->back() : open;
    here = here.normalized() * (chance(random, 0.2) ? 0.5 * open : event);
  }
  if (a == 1 && chance(random, 0.3)) {
    for (auto& contact : contacts) contact.one_sided = chance(random, 0.5);
    joint.equations = base.with(contacts);
  }
  const auto state = contact_state(joint.equations, c);
  const VectorXd q = joint.equations.residual(state, 0);
  if (q.cwiseAbs().maxCoeff() == 0) return;
  joint.equations.q = q;
  joint.exact = state.F;
}

}  // namespace

RandomJoint random_joint(std::uint32_t seed) {
  std::mt19937 random(seed);
  RandomJoint joint;
  joint.seed = seed;
  joint.family = static_cast<Family>(std::uniform_int_distribution<int>(0, family_names.size() - 1)(random));
  joint.ratio = decades(random, 1e-4, 1e4);
  const Base system = random_base(random, joint.family, static_cast<int>(decades(random, 3, 101)));
  const double F = system.q.cwiseAbs().maxCoeff(), k = system.S_ud.diagonal().mean();
  const Index n = system.q.size() / (joint.family == Family::discs ? 2 : 1);
  const double loose = chance(random, 0.3) ? 0 : uniform(random, 0.2, 1), gap = F / k * decades(random, 1e-4, 1e4);
  std::vector<Contact> contacts;
  for (Index j = 0; j < n; ++j) {
    joint.curves.push_back(
        random_curve(random, {F * decades(random, 0.3, 3), joint.ratio * k * decades(random, 0.5, 2)}));
    const double clearance = chance(random, loose) ? gap * decades(random, 0.1, 1) : 0;
    contacts.push_back({joint.curves.back().law, clearance, 1, false});
  }
  joint.equations = system.with(contacts);
  const bool limited = std::any_of(joint.curves.begin(), joint.curves.end(),
                                   [&](const Curve& curve) { return curve.at(1e9 * F / k, 0).slope == 0; });
  if (limited || joint.family == Family::contact || joint.family == Family::discs)
    load_from_solution(random, system, contacts, joint);
  return joint;
}

stage3::JointEquations random_falling_joint(std::uint32_t seed) {
  std::mt19937 random(seed);
  const int n = std::uniform_int_distribution<int>(1, 3)(random);
  const Base system = two_plates(random, Family::lap, n);
  const double F = system.q.cwiseAbs().maxCoeff(), k = system.S_ud.diagonal().maxCoeff();
  std::vector<Contact> contacts;
  for (int j = 0; j < n; ++j) {
    const double size = F * decades(random, 0.3, 3), unit = F / (k > 0 ? k : 1) * decades(random, 0.1, 10);
    const auto law = test::cubic_law(std::array{unit, 2 * unit, 3 * unit},
                                     std::array{size, size * uniform(random, 0.1, 2), size * uniform(random, 0.1, 3)});
    contacts.push_back({law, chance(random, 0.5) ? 0 : unit * uniform(random, 0, 1), 1, chance(random, 0.2)});
  }
  return system.with(contacts);
}

}  // namespace fastjoint::bench
