// SPDX-License-Identifier: GPL-3.0-or-later
// Peak hoop stress and pressure of a sheet with one pin in contact, by Newton's method on all finite-element unknowns:
// contact_newton PLATE.json GAP STIFFNESS FORCE. Neither waves nor closed forms: springs act at quadrature points of
// the rim, and the strain is the derivative of the elements' displacement along it. The pin's springs are given as if
// they also pulled; its disc is held along x and y by a spring of STIFFNESS to the ground, and FORCE acts on the first
// external.
#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>

#include "common/linalg/processor.hpp"
#include "common/rim/rim_compliance.hpp"
#include "stage1_plate/problem/plate_problem.hpp"
#include "tests/support/plates.hpp"

namespace {

using namespace fastjoint;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Quadrature points of a rim, side after side.
struct RimPoints {
  VectorXd angle, weight;                      ///< (n) radians, length^2
  std::vector<std::pair<Index, Index>> sides;  ///< first point and number of each
  stage1::Loads normal, tangential;            ///< unit forces times the weight of each point
};

RimPoints points_of(test::Plate& plate, const rim::Rim& rim, int p) {
  constexpr int n_pieces = 144;  // so that ends of contact lie close to ends of pieces
  std::vector<rim::AngleRange> pieces;
  for (int i = 0; i < n_pieces; ++i)
    pieces.push_back({i * rim::full_turn / n_pieces, (i + 1) * rim::full_turn / n_pieces});
  RimPoints points;
  std::vector<double> angle, weight;
  const auto& mesh = plate.mesh;
  for (const auto& side : rim.sides) {
    const auto rule = rim::rim_rule(mesh.mesh, mesh.edges, side, p, pieces);
    points.sides.emplace_back(std::ssize(angle), rule.ds.size());
    for (Index q = 0; q < rule.ds.size(); ++q) {
      const Eigen::Vector2d n = -rule.normal.col(q), t(-n.y(), n.x());
      const double area = mesh.mesh.thickness[side.element] * rule.ds[q];
      const auto add = [&](const Eigen::Vector2d& along, stage1::Loads& to) {
        stage1::add_load(plate.problem, side.element, rule.modes, area * (rule.N.col(q) * along.transpose()).reshaped(),
                         static_cast<int>(angle.size()), to);
      };
      add(n, points.normal);
      add(t, points.tangential);
      angle.push_back(std::atan2(n.y(), n.x()));
      weight.push_back(area);
    }
  }
  points.angle = Eigen::Map<VectorXd>(angle.data(), std::ssize(angle));
  points.weight = Eigen::Map<VectorXd>(weight.data(), std::ssize(weight));
  return points;
}

/// Derivative by the angle of a function that is a polynomial of degree p on each side.
VectorXd slope(const RimPoints& points, const VectorXd& values, int p) {
  VectorXd result(values.size());
  for (const auto& [first, n] : points.sides) {
    VectorXd x(n);
    for (Index i = 0; i < n; ++i) x[i] = rim::wrapped(points.angle[first + i] - points.angle[first]);
    const double scale = x.cwiseAbs().maxCoeff(), middle = (x.minCoeff() + x.maxCoeff()) / 2;
    x = 2 * (x.array() - middle) / scale;
    MatrixXd powers(n, p + 1), slopes = MatrixXd::Zero(n, p + 1);
    for (int k = 0; k <= p; ++k) powers.col(k) = x.array().pow(k);
    for (int k = 1; k <= p; ++k) slopes.col(k) = k * powers.col(k - 1) * 2 / scale;
    result.segment(first, n) = slopes * powers.colPivHouseholderQr().solve(values.segment(first, n));
  }
  return result;
}

struct Peaks {
  double hoop, pressure;
};

Peaks solve(const std::string& text, double gap, double stiffness, double force) {
  auto plate = test::make_plate(text);
  const int p = plate.scene.p_high;
  const auto pin = std::ranges::find_if(plate.scene.holes, [](const auto& hole) { return hole.spring.has_value(); });
  const auto& rim = plate.mesh.rims[pin - plate.scene.holes.begin()];
  const double K = pin->sprung().modulus;
  const RimPoints points = points_of(plate, rim, p);
  const Index n = points.angle.size(), n_free = plate.problem.unknowns.n_free.back();
  const auto on_free = [&](const stage1::Loads& all) -> MatrixXd {
    Eigen::SparseMatrix<double> L(n_free + 3, n);
    L.setFromTriplets(all.begin(), all.end());
    return L.topRows(n_free);
  };
  const MatrixXd normal = on_free(points.normal), tangential = on_free(points.tangential);
  const MatrixXd unit = test::unit_fields(plate.problem, p), under = test::fields_under(plate.problem, p, normal);
  const auto inverse = points.weight.cwiseInverse().asDiagonal();
  const MatrixXd radial = inverse * (normal.transpose() * unit), radial_by_p = inverse * (normal.transpose() * under);
  const MatrixXd along = inverse * (tangential.transpose() * unit),
                 along_by_p = inverse * (tangential.transpose() * under);
  const MatrixXd S = test::solve(plate).cases.back().S;
  const Index c = S.rows();  // externals, then the disc along x and y
  MatrixXd motion = -radial;
  motion.col(c - 2) += points.angle.array().cos().matrix();
  motion.col(c - 1) += points.angle.array().sin().matrix();
  VectorXd held = VectorXd::Zero(c), load = VectorXd::Zero(c);
  held.tail(2).setConstant(stiffness);
  load[0] = force;
  VectorXd x = VectorXd::Zero(n + c);  // w at the points, displacements
  constexpr int most = 100;
  for (int step = 0; step < most; ++step) {
    const VectorXd w = x.head(n), u = x.tail(c);
    const auto touches = (w.array() > gap).eval();
    const VectorXd pressure = K * touches.select(w.array() - gap, 0), added = pressure - K * w;
    VectorXd r(n + c);
    r << w + radial_by_p * added - motion * u,
        (S * u + motion.transpose() * points.weight.cwiseProduct(added) + held.cwiseProduct(u) - load) / K;
    if (r.lpNorm<Eigen::Infinity>() < 1e-12) {
      const VectorXd u_n = radial * u + radial_by_p * added, u_t = along * u + along_by_p * added;
      const VectorXd strain = (slope(points, u_t, p) + u_n) / rim.radius;
      const rim::RimCompliance sheet(plate.scene.elasticity[plate.mesh.mesh.material[rim.sides[0].element]].inverse(),
                                     rim.radius);
      Peaks peaks{-HUGE_VAL, pressure.maxCoeff()};
      for (Index q = 0; q < n; ++q) {
        const Eigen::Vector3d by = sheet.along(points.angle[q]);
        peaks.hoop = std::max(peaks.hoop, (strain[q] + by[0] * pressure[q]) / by[1]);
      }
      return peaks;
    }
    const VectorXd fall = K * (touches.cast<double>() - 1);
    MatrixXd J(n + c, n + c);
    J << MatrixXd::Identity(n, n) + radial_by_p * fall.asDiagonal(), -motion,
        motion.transpose() * points.weight.cwiseProduct(fall).asDiagonal() / K, (S + MatrixXd(held.asDiagonal())) / K;
    x -= J.partialPivLu().solve(r);
  }
  throw std::runtime_error("Newton's method did not end");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  linalg::set_threads(1);
  std::ifstream file(argv[1]);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto [hoop, pressure] = solve(text, std::atof(argv[2]), std::atof(argv[3]), std::atof(argv[4]));
  std::cout << fmt::format(R"({{"hoop": {}, "pressure": {}}})", hoop, pressure) << "\n";
}
