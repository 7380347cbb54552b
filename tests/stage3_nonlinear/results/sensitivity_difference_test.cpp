// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/path/walk.hpp"
#include "stage3_nonlinear/results/sensitivity.hpp"
#include "stage3_nonlinear/solvers/root.hpp"
#include "tests/stage3_nonlinear/named_laws.hpp"

namespace fastjoint::stage3::sensitivity_difference_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::NamedJoint;

/// A number of the joint, how to change it, and the derivative of the forces that is claimed.
struct Number {
  std::string name;
  double step;
  std::function<void(NamedJoint&, double)> add;
  VectorXd claimed;
  bool only_up = false;  ///< must not be less than it is
};

/// Which smooth piece a solution is on: corners of the laws ahead, open or not, sides that bear.
std::vector<Index> piece(const JointEquations& equations, const VectorXd& c) {
  const Index a = c.size() / std::ssize(equations.contacts);
  std::vector<Index> result;
  const VectorXd lengths = magnitudes(c, a), F = contact_state(equations, c).F;
  for (Index j = 0; j < std::ssize(lengths); ++j) {
    const Contact& contact = equations.contacts[j];
    const auto corners = contact.law->corners(contact.stiffness, contact.clearance).value_or(std::vector<double>{});
    const auto is_ahead = [&](double corner) { return std::abs(lengths[j]) < corner; };
    result.push_back(std::count_if(corners.begin(), corners.end(), is_ahead));
    result.push_back(F.segment(j * a, a).isZero(0));
    if (a == 1) result.push_back(lengths[j] < 0);
  }
  const auto& rubbing = equations.system->friction.friction_holes;
  for (std::size_t i = 0; i < rubbing.size(); ++i)
    for (const FrictionHole& hole : rubbing[i]) {
      const auto& [interface, row, friction] = equations.interfaces[i];
      const auto of_plane = [&](Index plane) {
        return plane < 0 || plane * a >= interface->size() ? 0 : F[row + plane * a + hole.direction];
      };
      result.push_back(of_plane(hole.hole - 1) < of_plane(hole.hole));  // the side that bears
    }
  return result;
}

struct Solution {
  VectorXd F;  ///< amounts
  std::vector<Index> piece;
};

/// A joint and its solution, from which changed joints are solved.
class Differences {
 public:
  explicit Differences(NamedJoint joint) : joint_(std::move(joint)), equations_(joint_.equations()) {
    path_ = follow(equations_, {joint_.load_factor}, test::tight);
    if (path_.failure) return;
    const PathStep& at = path_.steps[0];
    c_ = VectorXd(at.F.size());
    for (Index i = 0; i < std::ssize(c_); ++i) {
      const Contact& contact = equations_.contacts[i / joint_.model.n_directions()];
      c_[i] = contact.stiffness * at.delta[i] + (contact.law->rises() ? at.F[i] : 0);
    }
  }

  [[nodiscard]] bool usable() const {
    return !path_.failure && !path_.steps[0].check.mechanism && !path_.steps[0].F.isZero(0);
  }
  [[nodiscard]] std::vector<Number> numbers() const;
  /// Central difference, or forward of second order, or nothing where the changed joint fails or is on another piece.
  [[nodiscard]] std::optional<VectorXd> difference(const Number& number, double step) const {
    const auto here = solve(number, 0), above = solve(number, step);
    const auto other = solve(number, number.only_up ? 2 * step : -step);
    if (!here || !above || !other || above->piece != here->piece || other->piece != here->piece) return std::nullopt;
    if (number.only_up) return (4 * above->F - 3 * here->F - other->F) / (2 * step);
    return (above->F - other->F) / (2 * step);
  }
  [[nodiscard]] double force_scale() const { return stage3::force_scale(equations_, joint_.load_factor); }

 private:
  [[nodiscard]] std::optional<Solution> solve(const Number& number, double change) const {
    NamedJoint changed = joint_;
    number.add(changed, change);
    const JointEquations equations = changed.equations();
    const double scale = force_scale();
    const Root root = newton_root(root_problem(equations, changed.load_factor, scale), c_ / scale, {1e-14, 50});
    if (!(root.residual.cwiseAbs().maxCoeff() < 1e-12)) return std::nullopt;
    const VectorXd c = scale * root.x;
    return Solution{magnitudes(contact_state(equations, c).F, changed.model.n_directions()), piece(equations, c)};
  }

  NamedJoint joint_;
  JointEquations equations_;
  LoadPath path_;
  VectorXd c_;
};

/// The first external or traction of the plate of one.
test::HandMade::At first_of(const NamedJoint& joint, const std::string& external) {
  const auto is_it = [&](const PlateModel& plate) { return external.starts_with(plate.name + ":"); };
  return {std::ranges::find_if(joint.model.plates, is_it) - joint.model.plates.begin(), 0};
}

double& mu_of(test::HandMade& joint, const std::string& name) {
  for (auto& fastener : joint.fasteners)
    for (auto& hole : fastener.holes)
      if (joint.name(hole) == name) return joint.mu[joint.at(hole)];
  throw std::logic_error(name);
}

std::vector<Number> Differences::numbers() const {
  constexpr double small = 0.02;  // so that the error of differences is seen
  const JointNumbers names = joint_numbers(joint_.model, joint_.model.numbers());
  const test::Sensitivity by = test::sensitivity_at(names, test::point_of(equations_, path_.steps[0]));
  const double length = path_.steps[0].delta.cwiseAbs().maxCoeff();
  std::vector<Number> all{{"load factor", small, [](NamedJoint& j, double h) { j.load_factor += h; }, by.load_factor}};
  for (Index i = 0; i < std::ssize(joint_.model.planes); ++i) {
    const double clearance = joint_.model.clearance[i];
    all.push_back({"clearance", small * (clearance > 0 ? clearance : length),
                   [i](NamedJoint& j, double h) { j.model.clearance[i] += h; }, by.clearance.col(i), clearance == 0});
  }
  for (Index i = 0; i < by.law.cols(); ++i) {
    const auto& [law, parameter] = names.law[i];
    const double value = NamedJoint(joint_).laws.at(law).number(parameter.name);
    if (value == 0) continue;  // delta0, or slip: not to be negative
    all.push_back({law + " " + parameter.name, small * value,
                   [law, parameter](NamedJoint& j, double h) { j.laws.at(law).number(parameter.name) += h; },
                   by.law.col(i)});
  }
  for (Index i = 0; i < by.mu.cols(); ++i) {
    NamedJoint copy(joint_);
    const double mu = mu_of(copy.model, names.friction[i]);
    all.push_back({"mu " + names.friction[i], small * mu,
                   [name = names.friction[i]](NamedJoint& j, double h) { mu_of(j.model, name) += h; }, by.mu.col(i)});
  }
  for (Index i = 0; i < by.force.cols(); ++i) {
    const std::string name = names.force[i];
    const bool traction = name.ends_with(":T");
    all.push_back({name, small * force_scale(),
                   [name, traction](NamedJoint& j, double h) {
                     (traction ? j.model.traction : j.model.force)[first_of(j, name)] += h;
                   },
                   by.force.col(i)});
  }
  for (Index i = 0; i < by.displacement.cols(); ++i) {
    const std::string name = names.displacement[i];
    all.push_back({name, small * length,
                   [name](NamedJoint& j, double h) { j.model.displacement[first_of(j, name)] += h; },
                   by.displacement.col(i)});
  }
  return all;
}

/// What the differences of many numbers showed.
struct Tally {
  int compared = 0;
  std::vector<double> orders;
};

/// Errors of the change of the forces over one step, by steps h, h/2, h/4 and by Richardson's extrapolation of the last
/// two; nothing where there is a corner within h.
std::optional<std::array<double, 4>> errors(const Differences& joint, const Number& number, double step) {
  std::array<VectorXd, 3> difference;
  for (Index i = 0; i < 3; ++i) {
    const auto found = joint.difference(number, step / (1 << i));
    if (!found) return std::nullopt;
    difference[i] = *found - number.claimed;
  }
  return std::array{step * difference[0].norm(), step * difference[1].norm(), step * difference[2].norm(),
                    step * (4 * difference[2] - difference[1]).norm() / 3};
}

void compare(const Differences& joint, const Number& number, const std::string& where, Tally& tally) {
  double step = number.step;
  auto found = errors(joint, number, step);
  for (int i = 0; i < 2 && !found; ++i) found = errors(joint, number, step *= 0.02);
  if (!found) {
    ADD_FAILURE() << where << ", " << number.name << ": a corner next to the solution";
    return;
  }
  const auto& error = *found;
  ++tally.compared;
  const double rounding = 1e-11 * joint.force_scale();
  EXPECT_LT(error[3], 1e-4 * step * number.claimed.norm() + rounding) << where << ", " << number.name;
  if (error[2] < 10 * rounding) return;
  tally.orders.push_back(std::log2(error[0] / error[1]));
  tally.orders.push_back(std::log2(error[1] / error[2]));
}

class SensitivityOf : public testing::TestWithParam<int> {};

TEST_P(SensitivityOf, RandomJointsIsTheLimitOfCentralDifferences) {
  std::mt19937 random(61);
  Tally tally;
  int joints = 0;
  for (int i = 0; joints < 25; ++i) {
    ASSERT_LT(i, 30) << "few have no solution or no load";
    const Differences joint(test::named_joint(random, GetParam()));
    if (!joint.usable()) continue;
    ++joints;
    for (const auto& number : joint.numbers()) compare(joint, number, "joint " + std::to_string(i), tally);
  }
  EXPECT_GT(tally.compared, 200);
  ASSERT_GT(tally.orders.size(), 50U);
  std::sort(tally.orders.begin(), tally.orders.end());
  const auto order = [&](double share) {
    return tally.orders[static_cast<std::size_t>(share * static_cast<double>(tally.orders.size()))];
  };
  EXPECT_NEAR(order(0.5), 2, 0.02) << "h^2";
  EXPECT_GT(order(0.05), 1.95);
  EXPECT_LT(order(0.95), 2.05);
}

INSTANTIATE_TEST_SUITE_P(Kind, SensitivityOf, testing::Range(0, test::n_kinds));

}  // namespace
}  // namespace fastjoint::stage3::sensitivity_difference_test
