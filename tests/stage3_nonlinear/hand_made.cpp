// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/stage3_nonlinear/hand_made.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stage3_nonlinear/equations/first_guesses.hpp"
#include "stage3_nonlinear/path/walk.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::test {

using Eigen::Index;
using Eigen::MatrixXd;
using formats::PlateMatrices;

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

namespace {

/// Even over the decades.
double decades(std::mt19937& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

PlateMatrices from_stiffness(const MatrixXd& S, int n_discs, int n_externals) {
  PlateMatrices a;
  a.header.units = {"in", "lbf"};
  a.p = Eigen::VectorXi::Constant(1, 8);
  a.ndof = Eigen::VectorXi::Constant(1, 1);
  for (int i = 1; i <= n_discs; ++i) a.disc_hole.push_back(std::to_string(i));
  a.disc_direction.assign(a.disc_hole.size(), "x");
  a.disc_modulus = Eigen::VectorXd::Zero(n_discs);
  const std::vector<std::string> externals{"P", "Q"};
  a.external_id.assign(externals.begin(), externals.begin() + n_externals);
  a.external_direction.assign(a.external_id.size(), "x");
  a.S_dd = {S.topLeftCorner(n_discs, n_discs)};
  a.S_ed = {S.bottomLeftCorner(n_externals, n_discs)};
  a.S_ee = {S.bottomRightCorner(n_externals, n_externals)};
  a.S_dd_error = MatrixXd::Zero(n_discs, n_discs);
  a.S_ed_error = MatrixXd::Zero(n_externals, n_discs);
  a.S_ee_error = MatrixXd::Zero(n_externals, n_externals);
  a.R_df = {MatrixXd::Zero(n_discs, 0)};
  a.R_ef = {MatrixXd::Zero(n_externals, 0)};
  a.T_d = {MatrixXd::Zero(n_discs, 0)};
  a.T_e = {MatrixXd::Zero(n_externals, 0)};
  a.C_t = {MatrixXd::Zero(0, 0)};
  return a;
}

/// Linear, bilinear (perfectly plastic too) or in four stages.
std::shared_ptr<const stage3::Law> random_piecewise_law(std::mt19937& random) {
  const double k = decades(random, 100, 100000);
  const double F = decades(random, 30, 3000);
  const double yielding = uniform(random, 0, 1) < 0.2 ? 0.0 : k * uniform(random, 0.01, 0.5);
  const double kind = uniform(random, 0, 1);
  if (kind < 0.4) return linear_law(k);
  if (kind < 0.7) return bilinear_law(k, F, yielding);
  return law_of(fmt::format(R"({{"type": "four stage", "k_stick": {}, "F_slip": {}, "slip": {}, "k_bearing": {},
                                "F_yield": {}, "k_yield": {}, "reversible": true}})",
                            3 * k, 0.1 * F, decades(random, 1e-4, 1e-1), k, F, yielding));
}

std::shared_ptr<const stage3::Law> random_law(std::mt19937& random, const RandomJoint& kind) {
  if (kind.piecewise) return random_piecewise_law(random);
  if (kind.cubics && uniform(random, 0, 1) < 0.4) {
    // Rises for all delta: a cubic that turns down carries no more than its peak.
    const double F = decades(random, 30, 3000);
    const double d = decades(random, 0.003, 0.3);
    return cubic_law({d, 2 * d, 3 * d}, {F, 1.6 * F, 2.4 * F});
  }
  const double n = uniform(random, 0, 1) < 0.25 ? 1.0 : uniform(random, kind.least_n, 1.0);
  return power_law(decades(random, 100, 100000), n);
}

}  // namespace

PlateMatrices spring_plate(int n_discs, int n_externals, const std::vector<Spring>& springs) {
  MatrixXd S = MatrixXd::Zero(n_discs + n_externals, n_discs + n_externals);
  for (const auto& [a, b, k] : springs) {
    S(a, a) += k;
    if (b == ground) continue;
    S(b, b) += k;
    S(a, b) -= k;
    S(b, a) -= k;
  }
  PlateMatrices plate = from_stiffness(S, n_discs, n_externals);
  if (std::ranges::none_of(springs, [](const Spring& each) { return each.b == ground; })) plate.unsupported = {"x"};
  return plate;
}

PlateMatrices chain(int n_discs, int n_externals, double k, const std::vector<Spring>& more) {
  std::vector<Spring> springs = more;
  for (int i = 0; i + 1 < n_discs; ++i) springs.push_back({i, i + 1, k});
  return spring_plate(n_discs, n_externals, springs);
}

void add_friction(PlateMatrices& plate, std::mt19937& random) {
  const Index m = plate.n_discs();
  const Index e = plate.n_externals();
  plate.R_df[0] = MatrixXd::Zero(m, 2 * m);
  plate.R_ef[0] = MatrixXd::Zero(e, 2 * m);
  plate.friction_unit_force.resize(2 * m);
  plate.friction_resultant.resize(2 * m);
  for (Index i = 0; i < 2 * m; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    plate.friction_hole.push_back(plate.disc_hole[i / 2]);
    plate.friction_bearing.emplace_back(side > 0 ? "+x" : "-x");
    const double c = uniform(random, 0.005, 0.02);
    const double resultant = side * 2 / std::numbers::pi * c;
    plate.friction_unit_force[i] = c;
    plate.friction_resultant[i] = resultant;
    // The discs and boundaries that hold the plate share what holds the resultant, the disc of the hole most.
    for (Index row = 0; row < m; ++row) plate.R_df[0](row, i) = -resultant * uniform(random, 0, 0.3);
    for (Index row = 0; row < e; ++row) plate.R_ef[0](row, i) = -resultant * uniform(random, 0, 0.3);
    plate.R_df[0](i / 2, i) -= 0.4 * resultant;
  }
}

void HandMade::remove_fasteners() { fasteners.clear(), planes.clear(), law.clear(), clearance.clear(); }

stage3::Parameters HandMade::numbers() const {
  const auto value = [](const std::map<At, double>& all, const At& key) {
    const auto found = all.find(key);
    return found == all.end() ? 0 : found->second;
  };
  stage3::Parameters all;
  const auto loads = loads_of(*this);
  all.load.resize(std::ssize(loads));
  for (Index i = 0; i < std::ssize(loads); ++i) {
    const At key{loads[i].plate, loads[i].at};
    all.held.displaced.push_back(!loads[i].is_traction && displacement.contains(key));
    all.load[i] = value(loads[i].is_traction ? traction : all.held.displaced[i] ? displacement : force, key);
  }
  all.law = law;
  all.clearance = Eigen::VectorXd::Map(clearance.data(), std::ssize(clearance));
  std::vector<double> mus, gaps;
  for (const auto& fastener : fasteners)
    for (const auto& hole : fastener.holes) mus.push_back(value(mu, at(hole))), gaps.push_back(value(gap, at(hole)));
  all.mu = Eigen::VectorXd::Map(mus.data(), std::ssize(mus));
  all.gap = Eigen::VectorXd::Map(gaps.data(), std::ssize(gaps));
  std::vector<stage3::FreeShape> shapes;
  for (const auto& plate : plates) shapes.push_back(undisplaced(plate));
  set_free_shapes(*this, std::move(shapes), all);
  return all;
}

stage3::JointEquations make_equations(const HandMade& joint) {
  stage3::Parameters numbers = joint.numbers();
  const auto system = std::make_shared<const stage3::CondensedSystem>(condense(joint, numbers.held));
  return make_equations(joint, system, std::move(numbers));
}

HandMade joint_of(const Lap& lap, const std::shared_ptr<const stage3::Law>& law) {
  HandMade joint;
  joint.file = "joint.json";
  joint.units = lap.a.header.units;
  joint.p = 8;
  joint.plates = {stage3::make_plate("a", "a.h5", lap.a, 8), stage3::make_plate("b", "b.h5", lap.b, 8)};
  joint.force[{0, 0}] = lap.force;
  for (Index j = 0; j < std::min(lap.a.n_discs(), lap.b.n_discs()); ++j) add_fastener(joint, {{0, j}, {1, j}}, law);
  return joint;
}

void add_fastener(HandMade& joint, const std::vector<std::pair<Index, Index>>& holes,
                  const std::shared_ptr<const stage3::Law>& law, bool grounded) {
  stage3::FastenerModel fastener{std::to_string(joint.fasteners.size() + 1), {}, false, grounded};
  for (const auto& [plate, disc] : holes) fastener.holes.push_back({plate, disc});
  for (Index first = 0; first < fastener.n_planes(); ++first) {
    joint.planes.push_back({std::ssize(joint.fasteners), first, "law"});
    joint.law.push_back(law);
    joint.clearance.push_back(0);
  }
  joint.fasteners.push_back(std::move(fastener));
}

void set_friction(HandMade& joint, Index fastener, double mu) {
  for (auto& hole : joint.fasteners[fastener].holes) {
    const stage3::PlateModel& plate = joint.plates[hole.plate];
    joint.set_mu(hole, mu);
    hole.friction.resize(1);
    for (const auto side : {stage3::plus_side, stage3::minus_side}) {
      const Index column = 2 * hole.disc + (side == stage3::plus_side ? 0 : 1);
      hole.friction[0][side] = {column, plate.friction_unit_force[column], std::abs(plate.friction_resultant[column])};
    }
  }
}

stage3::FrictionCase add_case(stage3::PlateModel& plate, const stage3::HoleModel& hole, Index d, stage3::Side side,
                              const Eigen::VectorXd& load, double resultant) {
  const Index column = plate.R.cols();
  plate.R.conservativeResize(plate.n_unknowns(), column + 1);
  plate.R.col(column) = load;
  plate.friction_hole.push_back(plate.hole_of(hole.disc));
  plate.friction_bearing.push_back(
      name_of(rim::SignedAxis{static_cast<rim::Axis>(plate.axes[d]), side == stage3::plus_side ? 1 : -1}));
  for (auto* list : {&plate.friction_unit_force, &plate.friction_resultant}) list->conservativeResize(column + 1);
  plate.friction_unit_force[column] = 1;
  plate.friction_resultant[column] = side == stage3::plus_side ? resultant : -resultant;
  return {column, 1, resultant};
}

namespace {

/// Each plane as a fastener of its own.
std::vector<stage3::PlacedInterface> interfaces_of(const std::vector<stage3::Contact>& contacts, Index n_directions) {
  std::vector<stage3::PlacedInterface> result;
  for (Index j = 0; j < std::ssize(contacts); ++j)
    result.push_back({std::make_shared<stage3::FastenerInterface>(
                          std::vector{contacts[j]},
                          stage3::FastenerInterface::Place{.first_plane = j, .n_directions = n_directions}),
                      j * n_directions, 0});
  return result;
}

}  // namespace

stage3::JointEquations equations_of(const MatrixXd& S_ud, const Eigen::VectorXd& q,
                                    std::vector<stage3::Contact> contacts) {
  auto system = std::make_shared<stage3::CondensedSystem>(stage3::CondensedSystem{.S_ud = S_ud, .Q = q});
  system->load_columns = {{0, 0, 0, false, false}};
  Eigen::VectorXd own(std::ssize(contacts));
  for (Index j = 0; j < own.size(); ++j) own[j] = contacts[j].stiffness;
  set_reference(*system, own);
  stage3::JointEquations equations{system,
                                   {.load = Eigen::VectorXd::Ones(1), .law = {}, .clearance = {}, .mu = {}, .gap = {}},
                                   std::move(contacts),
                                   {},
                                   {},
                                   q,
                                   q};
  for (Index j = 0; j < own.size(); ++j) {
    equations.contacts[j].stiffness = system->stiffness[j];
    equations.rises = equations.rises && equations.contacts[j].law->rises();
  }
  equations.interfaces = interfaces_of(equations.contacts, q.size() / own.size());
  return equations;
}

stage3::ContactState state_of(const std::vector<stage3::Contact>& contacts, const Eigen::VectorXd& c) {
  const Index n = std::ssize(contacts), a = c.size() / n;
  return contact_state(interfaces_of(contacts, a), {}, a, n, c);
}

Eigen::VectorXd linear_solution(const HandMade& joint, double k) {
  const auto equations = make_equations(joint);
  return linear_forces(equations, Eigen::VectorXd::Constant(equations.n_unknowns(), 1 / k), 1).F;
}

Eigen::VectorXd displacements_of(const HandMade& joint, const Eigen::VectorXd& delta) {
  const auto equations = make_equations(joint);
  return displacements(joint, *equations.system, equations.load_rates(1), delta,
                       Eigen::VectorXd::Zero(equations.system->H.cols()));
}

HandMade random_joint(std::mt19937& random, const RandomJoint& kind) {
  const int n = std::uniform_int_distribution<int>(1, 12)(random);
  const double k_a = decades(random, 1e3, 1e5);
  const double k_b = decades(random, 1e3, 1e5);
  // A plate that holds itself would leave a floating one without load; so then the first is held only by its
  // own end.
  std::vector<Spring> left{{0, ground, k_b}};
  if (kind.floating) left.clear();
  Lap lap{chain(n, 1, k_a, {{n - 1, n, k_a}, {0, ground, kind.floating ? k_a : 0.1 * k_a}}), chain(n, 0, k_b, left),
          decades(random, 10, 10000)};
  if (kind.friction) {
    add_friction(lap.a, random);
    add_friction(lap.b, random);
  }
  auto joint = joint_of(lap, linear_law(1));
  for (Index j = 0; j < std::ssize(joint.planes); ++j) {
    auto& plane = joint.planes[j];
    joint.law[j] = random_law(random, kind);
    if (kind.clearances && uniform(random, 0, 1) < 0.6) joint.clearance[j] = decades(random, 1e-4, 1e-1);
    plane.one_sided = kind.one_sided && uniform(random, 0, 1) < 0.5;
    if (kind.friction && uniform(random, 0, 1) < 0.7) set_friction(joint, j, uniform(random, 0, 0.4));
  }
  return joint;
}

void add_contact(PlateMatrices& plate, const std::string& hole, double radius) {
  const rim::Harmonics waves{1};
  constexpr double modulus = 1, area = 1, compliance = 1e-3;
  plate.contact.push_back({hole, waves, modulus, radius, area});
  plate.waves.push_back({hole, waves, radius, area, modulus});
  plate.W = {MatrixXd::Zero(plate.n_loaded_waves(), plate.n_cases())};
  for (Index rim = 0, row = 0; rim < std::ssize(plate.contact); row += plate.waves[rim++].size())
    for (Index i = row; i < row + waves.size(); ++i)
      plate.W[0](i, plate.n_externals() + plate.n_discs() + i) = -compliance;
}

MatrixXd random_stiffness(std::mt19937& random, int n) {
  const MatrixXd A = MatrixXd::NullaryExpr(n, n, [&] { return uniform(random, -1, 1); });
  return A * A.transpose() + MatrixXd::Identity(n, n);
}

std::string write_joint(const TemporaryFolder& folder, const Lap& lap,
                        const std::map<std::string, std::string>& members) {
  formats::write(folder.path("a.h5"), lap.a);
  formats::write(folder.path("b.h5"), lap.b);
  return folder.write("joint.json", joint_text(members));
}

Lap two_fastener_lap() {
  constexpr double k = 1000;
  return {chain(2, 1, k, {{1, 2, k}}), chain(2, 0, k, {{0, ground, k}}), 100};
}

}  // namespace fastjoint::test
