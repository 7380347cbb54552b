// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/stage3_nonlinear/contact_joints.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "common/pfem/material.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr int n_waves = 4;

/// Shears of the rims: random loads of the body, which leave nothing over with what they leave to the discs.
/// @param H Moments of a rim by a translation, (k, a). @param G Displacements of the body by its unknowns.
void add_shears(std::mt19937& random, const MatrixXd& H, const MatrixXd& G, PlateModel& body) {
  const Index k = H.rows(), a = H.cols(), n = G.rows(), n_holes = std::ssize(body.holes);
  MatrixXd motion(n, a);
  for (Index i = 0; i < n_holes; ++i) motion.middleRows(i * k, k) = H;
  motion.bottomRows(1) = Eigen::RowVector2d(1, 0).head(a);
  const MatrixXd to_balance = motion * (motion.transpose() * motion).inverse();
  for (Index i = 0; i < n_holes; ++i) {
    const auto& pressures = body.waves[i].waves;
    MatrixXd drag(a, k);
    for (int axis = 0; axis < a; ++axis) drag.row(axis) = pressures.drag(axis).transpose();
    MatrixXd load = MatrixXd::Zero(n, k);
    load.middleRows(i * k, k) = MatrixXd::NullaryExpr(k, k, [&] { return uniform(random, -0.3, 0.3); });
    load += to_balance * (drag - motion.transpose() * load);
    auto R = body.R.middleCols(i * k, k);
    R = -G.transpose() * load;
    R.middleRows(i * a, a) += drag;
  }
}

/// A body with `n_holes` rims of contact and one external along x. With the moments v of the rims' own displacement and
/// the external's as unknowns its stiffness P is symmetric and positive definite, or zero for a translation; moments of
/// the discs against the rims, m = H D - v, make of it that of discs, external and moments.
/// Isotropic, or a laminate off its axes.
Eigen::Matrix3d random_sheet(std::mt19937& random) {
  const double E = decades(random, 300, 3000), nu = uniform(random, 0, 0.4);
  const double ratio = uniform(random, 0, 1) < 0.5 ? 1 : decades(random, 1, 14);
  const double G = ratio == 1 ? E / (2 * (1 + nu)) : E * uniform(random, 0.3, 0.6);
  const pfem::OrthotropicConstants constants{ratio * E, E, E, nu, nu, nu, G};
  return pfem::elasticity(constants, uniform(random, 0, 3), pfem::Analysis::plane_stress).inverse();
}

PlateModel random_body(std::mt19937& random, const ContactKind& kind, bool floating) {
  const rim::Harmonics pressures{n_waves};
  const Index k = pressures.size(), n = kind.n_holes * k + 1, a = kind.n_directions, m = kind.n_holes * a;
  MatrixXd P = MatrixXd::NullaryExpr(n, n, [&] { return uniform(random, -1, 1); });
  P = (1000.0 / double(n) * P * P.transpose()).eval();
  P.diagonal().array() += 300;
  MatrixXd H = MatrixXd::Zero(k, a);  // means of the distributions times cos theta and sin theta
  H(1, 0) = std::numbers::sqrt2 / 2;
  if (a > 1) H(2, 1) = std::numbers::sqrt2 / 2;
  if (floating) {  // no stiffness against moving along the axes
    MatrixXd motion = MatrixXd::Zero(n, a);
    for (Index i = 0; i < kind.n_holes; ++i) motion.middleRows(i * k, k) = H;
    motion(n - 1, 0) = 1;
    const MatrixXd rest =
        MatrixXd::Identity(n, n) - motion * (motion.transpose() * motion).inverse() * motion.transpose();
    P = (rest * P * rest).eval();
  }
  MatrixXd G = MatrixXd::Zero(n, m + 1 + n - 1);
  for (Index i = 0; i < kind.n_holes; ++i) {
    G.block(i * k, i * a, k, a) = H;
    G.block(i * k, m + 1 + i * k, k, k) = -MatrixXd::Identity(k, k);
  }
  G(n - 1, m) = 1;
  PlateModel body;
  for (Index i = 0; i < kind.n_holes; ++i) {
    body.holes.push_back(fmt::format("{}", i + 1));
    auto& rim = body.contact.emplace_back(formats::ContactRim{body.holes.back(),
                                                              rim::Harmonics{kind.short_waves ? 4 * n_waves : n_waves},
                                                              decades(random, 100, 10000), 1, 1});
    if (kind.short_waves && uniform(random, 0, 1) < 0.5)
      rim.disk = {decades(random, 100, 10000), uniform(random, 0, 0.5)};
    auto& carried = body.waves.emplace_back(formats::WaveRim{rim.hole, pressures, rim.radius, rim.area, rim.modulus});
    if (kind.short_waves) carried.compliance = random_sheet(random);
    body.contact_waves.push_back(std::make_shared<const ContactWaves>(rim, carried));
  }
  body.on_springs.assign(body.holes.size(), true);
  for (Index d = 0; d < a; ++d) body.axes.push_back(static_cast<int>(d));
  for (Index i = 0; i < m; ++i) body.discs.push_back(i);
  body.external_id = {"P"};
  body.external_axis = {0};
  body.S = G.transpose() * P * G;
  body.R = MatrixXd::Zero(body.S.rows(), kind.n_holes * pressures.n_shears());
  body.T = MatrixXd::Zero(body.S.rows(), 0);
  if (kind.mu > 0) add_shears(random, H, G, body);
  body.degree = 8;
  body.S_error = MatrixXd::Zero(body.S.rows(), body.S.rows());
  return body;
}

std::shared_ptr<const Law> random_law(std::mt19937& random) {
  const double kind = uniform(random, 0, 1), k = decades(random, 100, 100000);
  if (kind < 0.2) return test::law_of(R"({"type": "rigid"})");
  if (kind < 0.5) return test::linear_law(k);
  if (kind < 0.75) return test::bilinear_law(k, decades(random, 0.1, 10), 0.2 * k);
  return test::power_law(decades(random, 10, 10000), uniform(random, 0.4, 1));
}

}  // namespace

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

double decades(std::mt19937& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

test::HandMade random_contact_joint(std::mt19937& random, const ContactKind& kind) {
  test::HandMade joint;
  joint.file = "joint.json";
  joint.p = 8;
  joint.plates = {random_body(random, kind, kind.floating), random_body(random, kind, false)};
  joint.plates[0].name = std::string("a"), joint.plates[1].name = std::string("b");
  joint.axes = joint.plates[0].axes;
  joint.force[{0, 0}] = 1;
  if (!kind.floating && uniform(random, 0, 1) < 0.3) joint.displacement[{0, 0}] = 0.01;
  for (Index i = 0; i < kind.n_holes; ++i) {
    test::add_fastener(joint, {{0, i * kind.n_directions}, {1, i * kind.n_directions}}, random_law(random));
    joint.planes.back().law_name = joint.fasteners.back().id;
    for (HoleModel& hole : joint.fasteners.back().holes) joint.set_mu(hole, kind.mu);
    for (HoleModel& hole : joint.fasteners.back().holes)
      joint.gap[joint.at(hole)] = (uniform(random, 0, 1) < 0.3 ? -1 : 1) * kind.gaps * 0.003 * uniform(random, 0, 1);
  }
  return joint;
}

}  // namespace fastjoint::stage3
