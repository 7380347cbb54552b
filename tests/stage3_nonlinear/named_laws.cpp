// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/stage3_nonlinear/named_laws.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/input/value.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using stage3::PlateModel;

namespace {

/// A law of each type but tables and formulas in turn, of about the force F at about the displacement d.
LawText random_law(std::mt19937& random, Index type, double F, double d) {
  const auto u = [&](double low, double high) { return uniform(random, low, high); };
  const double k = F / d * u(0.3, 3);
  switch (type % 6) {
    case 0:
      return {"linear", {{"k", k}}};
    case 1: {
      const double n = u(0.4, 0.95);
      return {"power", {{"A", F / std::pow(d, n) * u(0.5, 2)}, {"n", n}, {"delta0", type % 4 == 1 ? 0.1 * d : 0.0}}};
    }
    case 2:
      return {"bilinear", {{"k", k}, {"F_yield", F * u(0.1, 0.6)}, {"k_yield", k * u(0.05, 0.5)}}};
    case 3: {
      const double slips = F * u(0.02, 0.2);
      return {"four stage",
              {{"k_stick", 5 * k},
               {"F_slip", slips},
               {"slip", d * u(0, 0.1)},
               {"k_bearing", k},
               {"F_yield", slips + F * u(0.1, 0.5)},
               {"k_yield", k * u(0.05, 0.5)}}};
    }
    case 4:
      return {"cubic", {{"F[0]", F}, {"F[1]", 1.6 * F}, {"F[2]", 2.4 * F}}, 3 * d * u(0.3, 2)};
    default:  // turns down far beyond what comes
      return {"cubic", {{"F[0]", 4 * F}, {"F[1]", 7 * F}, {"F[2]", 9 * F}}, 12 * d * u(0.3, 2)};
  }
}

/// A sheet that holds itself, with one external and one traction.
PlateModel random_plate(std::mt19937& random, const std::string& name, Index n_holes, std::vector<int> axes) {
  PlateModel plate;
  plate.name = name;
  plate.axes = std::move(axes);
  for (Index i = 0; i < n_holes; ++i) plate.holes.push_back(std::to_string(i + 1));
  plate.external_id = {"P"};
  plate.external_axis = plate.traction_axis = {0};
  plate.traction_id = {"T"};
  const Index n = plate.n_disc_unknowns() + 1;
  plate.S = uniform(random, 300, 3000) * random_stiffness(random, static_cast<int>(n));
  plate.R = MatrixXd::Zero(n, 0);
  plate.T = MatrixXd::NullaryExpr(n, 1, [&] { return uniform(random, -0.5, 0.5); });
  return plate;
}

/// Friction cases of about the size and in the sense that real plates have (hand_made's add_friction), any direction.
void add_random_friction(std::mt19937& random, HandMade& joint) {
  for (auto& fastener : joint.fasteners) {
    fastener.law_includes_friction = fastener.id == "2";
    for (auto& hole : fastener.holes) {
      if (uniform(random, 0, 1) < 0.3) continue;
      joint.set_mu(hole, uniform(random, 0.02, 0.3));
      for (Index d = 0; d < joint.n_directions(); ++d) {
        auto& sides = hole.friction.emplace_back();
        for (const auto side : {stage3::plus_side, stage3::minus_side}) {
          const double amplitude = side == stage3::plus_side ? -0.6 : 0.6;
          VectorXd load = VectorXd::NullaryExpr(joint.plates[hole.plate].n_unknowns(),
                                                [&] { return amplitude * uniform(random, 0, 0.2); });
          load[hole.disc + d] += 0.4 * amplitude;
          sides[side] = add_case(joint.plates[hole.plate], hole, d, side, load, 0.6);
        }
      }
    }
  }
}

/// Plates with fasteners through all of them, the second of which and every other one the ground may hold; forces, a
/// traction and a given displacement.
HandMade random_stack(std::mt19937& random, Index n_plates, const std::vector<int>& axes, bool grounded = false) {
  const Index n = std::uniform_int_distribution<Index>(2, 4)(random);
  HandMade joint;
  joint.file = "joint.json";
  joint.units = {"in", "lbf"};
  joint.axes = axes;
  for (Index i = 0; i < n_plates; ++i)
    joint.plates.push_back(random_plate(random, std::string(1, static_cast<char>('a' + i)), n, axes));
  joint.force[{0, 0}] = 1000;
  joint.traction[{0, 0}] = 300;
  joint.displacement[{n_plates - 1, 0}] = 0.05;
  for (Index j = 0; j < n; ++j) {
    std::vector<std::pair<Index, Index>> holes;
    for (Index i = 0; i < n_plates; ++i) holes.emplace_back(i, j * joint.n_directions());
    add_fastener(joint, holes, linear_law(1), grounded && (n_plates == 1 || j % 2 == 1));
  }
  return joint;
}

HandMade random_model(std::mt19937& random, int kind) {
  const std::vector<int> x{0}, xy{0, 1};
  switch (kind) {
    case 0:
      return random_joint(random, {});
    case 1:
      return random_joint(random, {.friction = true});
    case 2:
      return random_joint(random, {.one_sided = true});
    case 3:
      return random_joint(random, {.friction = true, .floating = true});
    case 4:
    case 5:
      return random_stack(random, 3, x);
    case 6:
      return random_stack(random, 2, xy);
    case 7:
      return random_stack(random, 3, xy);
    case 8:
      return random_stack(random, 1, x, true);
    default:
      return random_stack(random, 3, xy, true);
  }
}

}  // namespace

double& LawText::number(const std::string& name) {
  return std::find_if(numbers.begin(), numbers.end(), [&](const auto& each) { return each.first == name; })->second;
}

std::shared_ptr<const stage3::Law> LawText::law() const {
  std::string text;
  if (type == "cubic") {
    const double d = last_delta / 3;
    text = fmt::format(R"(, "delta": [{}, {}, {}], "F": [{}, {}, {}])", d, 2 * d, 3 * d, numbers[0].second,
                       numbers[1].second, numbers[2].second);
  } else {
    for (const auto& [name, value] : numbers) text += fmt::format(R"(, "{}": {})", name, value);
    if (type == "bilinear" || type == "four stage") text += R"(, "reversible": true)";
  }
  const auto document = input::parse("joint.json", fmt::format(R"({{"type": "{}"{}}})", type, text));
  return stage3::read_law(input::Value(document));
}

stage3::JointEquations NamedJoint::equations() {
  std::map<std::string, std::shared_ptr<const stage3::Law>> made;
  for (const auto& [name, text] : laws) made[name] = text.law();
  for (Index j = 0; j < model.n_planes(); ++j) model.law[j] = made.at(model.planes[j].law_name);
  return make_equations(model);
}

NamedJoint named_joint(std::mt19937& random, int kind) {
  NamedJoint joint{random_model(random, kind), {}};
  if (kind == 5 || kind >= 7) add_random_friction(random, joint.model);
  const auto equations = make_equations(joint.model);
  const double q = equations.q.cwiseAbs().maxCoeff();
  const double F = q > 0 ? q : 1;  // a sheet that one fastener alone holds and nothing loads
  const double stiffest = equations.system->S_ud.diagonal().maxCoeff();
  // None of a sheet that one fastener holds.
  const double d = stiffest > 1e-9 * F ? F / stiffest : 0.01;
  const auto first = std::uniform_int_distribution<std::size_t>(0, 11)(random);
  const std::vector<std::string> names{"left", "middle", "right"};
  for (Index i = 0; i < std::ssize(names); ++i) joint.laws[names[i]] = random_law(random, first + i, F, d);
  if (kind > 7) joint.laws["middle"] = {"rigid", {}};
  for (Index j = 0; j < std::ssize(joint.model.planes); ++j) {
    joint.model.planes[j].law_name = names[(j * 2 + first) % 3];
    joint.model.clearance[j] = uniform(random, 0, 1) < 0.5 ? 0 : d * uniform(random, 0, 0.4);
  }
  joint.load_factor = uniform(random, 0.5, 1.5) * (kind == 2 || uniform(random, 0, 1) < 0.7 ? 1 : -1);
  return joint;
}

}  // namespace fastjoint::test
