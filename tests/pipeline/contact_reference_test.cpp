// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of a pin in a strip by Newton's method on all finite-element unknowns, with springs and friction at
// quadrature points of the rim instead of pressures and shears of contact: the reference for B, C, R and for joints.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "stage1_plate/problem/plate_problem.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"
#include "tests/support/plates.hpp"
#include "tests/support/sweep.hpp"

namespace fastjoint {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int p = 7;
constexpr double force = 10000;

/// A strip with a hole, its left edge an external that moves along x.
std::string strip(const std::string& contact, const std::string& waves = "") {
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress", "p": {},
    "materials": {{"al": {{"E": 72000, "nu": 0.3}}}},
    "geometry": {{"grid": {{"x": [0, 40, 80, 100], "y": [0, 40], "thickness": 2}}}},
    "holes": [{{"id": "1", "center": [60, 20], "radius": 5, "rings": 0{}, "spring": {{"disk": {{"E": 210000, "nu": 0.3}}{}}}}}],
    "disc_directions": ["x", "y"], "supports": [{{"on": "left", "fix": ["y"]}}],
    "external": [{{"id": "P", "on": "left", "direction": "x", "kind": "rigid"}}]}})",
                     p, waves, contact);
}

/// The strip with springs all around, and pressures and shears at quadrature points of its rim.
class Reference {
 public:
  Reference() : plate_(test::make_plate(strip(""))) {
    const auto& mesh = plate_.mesh;
    std::vector<rim::AngleRange> pieces;
    constexpr int n_pieces = 64;
    for (int i = 0; i < n_pieces; ++i)
      pieces.push_back({i * rim::full_turn / n_pieces, (i + 1) * rim::full_turn / n_pieces});
    stage1::Loads loads, shears;
    for (const auto& side : mesh.rims[0].sides) {
      const auto rule = rim::rim_rule(mesh.mesh, mesh.edges, side, p, pieces);
      for (Index q = 0; q < rule.ds.size(); ++q) {
        const Eigen::Vector2d n = -rule.normal.col(q), t(-n.y(), n.x());
        const double weight = mesh.mesh.thickness[side.element] * rule.ds[q];
        const auto add = [&](const Eigen::Vector2d& along, stage1::Loads& to) {
          stage1::add_load(plate_.problem, side.element, rule.modes,
                           weight * (rule.N.col(q) * along.transpose()).reshaped(), static_cast<int>(weight_.size()),
                           to);
        };
        add(n, loads);
        add(t, shears);
        angle_.push_back(std::atan2(n.y(), n.x()));
        weight_.push_back(weight);
      }
    }
    const Index points = std::ssize(weight_), n_free = plate_.problem.unknowns.n_free.back();
    const auto on_free = [&](const stage1::Loads& all) -> MatrixXd {
      Eigen::SparseMatrix<double> L(n_free + 3, points);
      L.setFromTriplets(all.begin(), all.end());
      return L.topRows(n_free);
    };
    const MatrixXd free = on_free(loads), free_shear = on_free(shears);
    const VectorXd inverse = weights().cwiseInverse();
    const auto per_weight = inverse.asDiagonal();
    const MatrixXd unit_fields = test::unit_fields(plate_.problem, p);
    by_motion_ = -(per_weight * free.transpose()) * unit_fields;
    slip_by_motion_ = -(per_weight * free_shear.transpose()) * unit_fields;
    for (Index q = 0; q < points; ++q) {
      by_motion_.row(q).tail(2) += normal(q).transpose();
      slip_by_motion_.row(q).tail(2) += tangent(q).transpose();
    }
    by_pressure_ = per_weight * free.transpose() * test::fields_under(plate_.problem, p, free);
    by_shear_ = per_weight * free.transpose() * test::fields_under(plate_.problem, p, free_shear);
    S_ = test::solve(plate_).cases.back().S;
  }

  [[nodiscard]] VectorXd weights() const { return Eigen::Map<const VectorXd>(weight_.data(), std::ssize(weight_)); }
  [[nodiscard]] double modulus() const { return plate_.scene.holes[0].sprung().modulus; }
  /// Distributions at the points, (points, k).
  [[nodiscard]] MatrixXd distributions(const rim::Harmonics& pressures) const {
    return at_points(&rim::Harmonics::at, pressures);
  }
  /// Displacement of the disc against the rim at the points per unit displacement of external, disc x, disc y.
  [[nodiscard]] const MatrixXd& by_motion() const { return by_motion_; }
  /// Displacement of the rim along its normal at every point per pressure at each point.
  [[nodiscard]] const MatrixXd& by_pressure() const { return by_pressure_; }

  /// Shears at the points, (points, k).
  [[nodiscard]] MatrixXd shears(const rim::Harmonics& pressures) const {
    return at_points(&rim::Harmonics::shears_at, pressures);
  }
  /// The same along its tangent.
  [[nodiscard]] const MatrixXd& slip_by_motion() const { return slip_by_motion_; }
  /// Displacement of the rim along its normal at every point per shear at each point.
  [[nodiscard]] const MatrixXd& by_shear() const { return by_shear_; }

  struct Solution {
    double displacement, peak_pressure;
    int steps;
  };
  /// Displacement of the external under the force, with the disc held, this gap and this friction. Each step takes the
  /// friction of the step before.
  [[nodiscard]] Solution solve(double gap, double mu = 0) const {
    const Index n = std::ssize(weight_);
    const double K = modulus();
    const VectorXd motion = by_motion_.col(0);
    VectorXd x = VectorXd::Zero(n + 1);  // w at the points, displacement
    for (int step = 1; step < 200; ++step) {
      const VectorXd w = x.head(n);
      const auto touches = (w.array() > gap).eval();
      const VectorXd added = K * (touches.select(w.array() - gap, 0) - w.array());
      const VectorXd slope = K * (touches.cast<double>() - 1);
      const VectorXd shear = mu * friction(K * touches.select(w.array() - gap, 0));
      VectorXd r(n + 1);
      r << w + by_pressure_ * added + by_shear_ * shear - motion * x[n],
          (S_(0, 0) * x[n] + motion.dot(weights().cwiseProduct(added)) +
           slip_by_motion_.col(0).dot(weights().cwiseProduct(shear)) + force) /
              K;
      if (r.lpNorm<Eigen::Infinity>() < 1e-13) return {x[n], K * (w.maxCoeff() - gap), step};
      MatrixXd J(n + 1, n + 1);
      J << MatrixXd::Identity(n, n) + by_pressure_ * slope.asDiagonal(), -motion,
          motion.cwiseProduct(weights()).cwiseProduct(slope).transpose() / K, S_(0, 0) / K;
      x -= J.partialPivLu().solve(r);
    }
    ADD_FAILURE() << "Newton's method did not end";
    return {};
  }

 private:
  [[nodiscard]] MatrixXd at_points(VectorXd (rim::Harmonics::*values)(double) const,
                                   const rim::Harmonics& pressures) const {
    MatrixXd rows(std::ssize(angle_), (pressures.*values)(0).size());
    for (Index q = 0; q < rows.rows(); ++q) rows.row(q) = (pressures.*values)(angle_[q]).transpose();
    return rows;
  }
  [[nodiscard]] Eigen::Vector2d normal(Index q) const { return {std::cos(angle_[q]), std::sin(angle_[q])}; }
  [[nodiscard]] Eigen::Vector2d tangent(Index q) const { return {-std::sin(angle_[q]), std::cos(angle_[q])}; }
  /// Pressure with the sign of the shear by which it drags the rim along its resultant.
  [[nodiscard]] VectorXd friction(const VectorXd& pressure) const {
    Eigen::Vector2d resultant(0, 0);
    for (Index q = 0; q < pressure.size(); ++q) resultant += weight_[q] * pressure[q] * normal(q);
    VectorXd shear = pressure;
    for (Index q = 0; q < pressure.size(); ++q)
      if (tangent(q).dot(resultant) < 0) shear[q] *= -1;
    return shear;
  }

  test::Plate plate_;
  std::vector<double> angle_, weight_;
  MatrixXd by_motion_, slip_by_motion_, by_pressure_, by_shear_, S_;
};

class ContactReference : public testing::Test {
 protected:
  static void SetUpTestSuite() { reference_ = std::make_unique<Reference>(); }
  static void TearDownTestSuite() { reference_.reset(); }
  static std::unique_ptr<Reference> reference_;
};
std::unique_ptr<Reference> ContactReference::reference_;

/// All waves of the joint are those of the elements.
formats::PlateMatrices with_harmonics(int n) {
  return test::extract(strip(fmt::format(R"(, "compression_only": true, "harmonics": {})", n),
                             fmt::format(R"(, "waves": {})", n)),
                       false)
      .matrices;
}

/// Each wave's distribution, pressures, then shears, times the weights of the points.
MatrixXd moments(const Reference& reference, const rim::Harmonics& waves) {
  MatrixXd all(reference.weights().size(), waves.size() + waves.n_shears());
  all << reference.distributions(waves), reference.shears(waves);
  return (reference.weights().asDiagonal() * all).transpose();
}

TEST_F(ContactReference, WavesAreThoseOfSolvedFields) {
  const auto a = with_harmonics(9);
  const rim::Harmonics& waves = a.waves.at(0).waves;
  const Index n = waves.size(), n_t = waves.n_shears();
  EXPECT_NEAR(a.contact[0].area, reference_->weights().sum(), 1e-9);
  const MatrixXd all = moments(*reference_, waves), normal = all.topRows(n), along = all.bottomRows(n_t);
  const MatrixXd phi = reference_->distributions(waves), psi = reference_->shears(waves);
  const MatrixXd B = normal * reference_->by_motion(), C = -normal * reference_->by_pressure() * phi;
  const MatrixXd R = along * reference_->slip_by_motion(), R_p = -normal * reference_->by_shear() * psi;
  const auto& W = a.W[0];
  EXPECT_LT((W.topLeftCorner(n, 3) - B).norm(), 1e-10 * B.norm());
  EXPECT_LT((W.block(0, 3, n, n) - C).norm(), 1e-10 * C.norm());
  EXPECT_LT((W.block(n, 0, n_t, 3) - R).norm(), 1e-10 * R.norm());
  EXPECT_LT((W.block(0, 3 + n, n, n_t) - R_p).norm(), 1e-10 * R_p.norm());
  EXPECT_LT((W.block(n, 3, n_t, n) - R_p.transpose()).norm(), 1e-10 * R_p.norm());
}

/// The error of the displacement falls as the square of that of the pressure, which is of the order N^-2, until it is
/// that of the reference, about 1e-6; friction jumps, and its error falls more slowly.
TEST_F(ContactReference, JointsComeCloserWithEveryWave) {
  std::vector<std::pair<double, double>> gaps_and_frictions{{0.02, 0.0},  {-0.02, 0.3}, {0.0, 0.0},
                                                            {-0.02, 0.0}, {0.0, 0.3},   {0.02, 0.3}};
  gaps_and_frictions.resize(test::scenes(6));
  for (const auto& [gap, mu] : gaps_and_frictions) {
    const auto exact = reference_->solve(gap, mu);
    EXPECT_LT(exact.steps, mu > 0 ? 100 : 15);
    for (const int harmonics : {4, 8, 16, 32}) {
      test::HandMade joint;
      joint.file = "joint.json";
      joint.plates = {stage3::make_plate("strip", "strip.h5", with_harmonics(harmonics), p)};
      joint.axes = {0, 1};
      joint.force[{0, 0}] = -force;
      test::add_fastener(joint, {{0, 0}}, test::law_of(R"({"type": "rigid"})"), true);
      stage3::HoleModel& hole = joint.fasteners[0].holes[0];
      joint.gap[joint.at(hole)] = gap;
      joint.set_mu(hole, mu);
      const auto equations = make_equations(joint);
      const auto path = stage3::follow(equations, {1}, {});
      ASSERT_FALSE(path.failure);
      const auto& step = path.steps[0];
      const VectorXd u =
          stage3::displacements(joint, *equations.system, equations.load_rates(1), step.all_delta(), step.Lambda);
      const double error = std::abs(u[2] / exact.displacement - 1);
      const double order = mu > 0 ? 3 : 4, reference = mu > 0 ? 2e-6 : 1e-6;
      EXPECT_LT(error, 5e-4 * std::pow(4.0 / harmonics, order) + reference)
          << harmonics << " waves, gap " << gap << ", friction " << mu;
      const stage3::CompressionOnlyRim& rim = equations.rims[0]->contact();
      const VectorXd w = equations.rims[0]->solve(equations.of_rim(step.c, 0)).w;
      const double depth = rim.depth(w, rim.deepest(w));
      if (harmonics == 32) {
        EXPECT_LT(error, reference) << gap;
        EXPECT_NEAR(equations.rims[0]->modulus() * depth / exact.peak_pressure, 1, 1e-3) << gap;
      }
    }
  }
}

}  // namespace
}  // namespace fastjoint
