// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/stage3_nonlinear/stacks.hpp"
#include "stage3_nonlinear/path/load_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace fastjoint::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

formats::PlateMatrices disc_plate(const MatrixXd& S, const std::vector<std::string>& directions) {
  auto plate = spring_plate(static_cast<int>(S.rows()), 0, {});
  plate.S_dd[0] = S;
  const auto a = static_cast<int>(directions.size());
  for (int i = 0; i < S.rows(); ++i) {
    plate.disc_hole[i] = std::to_string(i / a + 1);
    plate.disc_direction[i] = directions[i % a];
  }
  return plate;
}

HandMade joint_of(const std::vector<formats::PlateMatrices>& plates) {
  HandMade joint;
  joint.file = "joint.json";
  joint.units = plates[0].header.units;
  joint.p = 8;
  for (Index i = 0; i < std::ssize(plates); ++i) {
    const std::string name(1, static_cast<char>('a' + i));
    joint.plates.push_back(stage3::make_plate(name, name + ".h5", plates[i], 8));
  }
  joint.axes = joint.plates[0].axes;
  return joint;
}

void load_discs(HandMade& joint, Index plate, const VectorXd& forces) {
  joint.plates[plate].T = -forces;
  joint.plates[plate].traction_id = {"T"};
  joint.traction[{plate, 0}] = 1;
  joint.plates[plate].traction_axis = {joint.axes[0]};
}

HandMade random_stack(std::mt19937& random, int n_plates, int n_holes, int n_directions, bool grounded) {
  std::uniform_real_distribution<double> number(-1, 1);
  const std::vector<std::string> directions =
      n_directions == 1 ? std::vector<std::string>{"x"} : std::vector<std::string>{"x", "y"};
  std::vector<formats::PlateMatrices> plates;
  plates.reserve(n_plates);
  for (int i = 0; i < n_plates; ++i)
    plates.push_back(disc_plate(100 * random_stiffness(random, n_holes * n_directions), directions));
  auto joint = joint_of(plates);
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    load_discs(joint, i, VectorXd::NullaryExpr(joint.plates[i].n_disc_unknowns(), [&] { return 10 * number(random); }));
  std::vector<Index> order(joint.plates.size());
  std::iota(order.begin(), order.end(), 0U);
  for (int hole = 0; hole < n_holes; ++hole) {
    std::shuffle(order.begin(), order.end(), random);
    const Index count =
        hole == 0 ? std::ssize(order) : std::uniform_int_distribution<Index>(2, std::ssize(order))(random);
    std::vector<std::pair<Index, Index>> holes;
    for (Index i = 0; i < count; ++i) holes.emplace_back(order[i], hole * n_directions);
    add_fastener(joint, holes, linear_law(std::exp(3 + 3 * number(random))), grounded && hole % 2 == 0);
  }
  return joint;
}

LoosePlates loose_plates(const HandMade& joint) {
  const Index n = joint.n_unknowns();
  LoosePlates result{MatrixXd::Zero(n, n), VectorXd(n)};
  for (Index plate = 0; plate < std::ssize(joint.plates); ++plate) {
    const Index at = joint.offset(plate), m = joint.plates[plate].n_disc_unknowns();
    result.S.block(at, at, m, m) = joint.plates[plate].S;
    result.load.segment(at, m) = -joint.plates[plate].T;
  }
  return result;
}

double stiffness_of(const stage3::Law& law) { return law.at(1, 1, 0).F / law.at(1, 1, 0).delta; }

stage3::PathStep solved(const HandMade& joint) {
  const auto path = stage3::follow(make_equations(joint), {1}, {.initial = {}, .solver = {.tolerance = 1e-13}});
  EXPECT_FALSE(path.failure);
  return path.steps.at(0);
}

stage3::JointState state_of(const HandMade& joint, const stage3::PathStep& step) {
  return stage3::joint_state(joint, make_equations(joint), step);
}

}  // namespace fastjoint::test
