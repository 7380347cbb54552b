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

/// Values at `x`, and the derivative by x, of the polynomial of degree p through values at other points.
std::pair<VectorXd, VectorXd> interpolated(const VectorXd& at, const VectorXd& values, const VectorXd& x, int p) {
  const double scale = (at.maxCoeff() - at.minCoeff()) / 2, middle = (at.maxCoeff() + at.minCoeff()) / 2;
  const auto powers = [&](const VectorXd& places) {
    MatrixXd all(places.size(), p + 1);
    for (int k = 0; k <= p; ++k) all.col(k) = ((places.array() - middle) / scale).pow(k);
    return all;
  };
  const VectorXd coefficients = powers(at).colPivHouseholderQr().solve(values);
  const MatrixXd there = powers(x);
  VectorXd slope = VectorXd::Zero(x.size());
  for (int k = 1; k <= p; ++k) slope += k / scale * coefficients[k] * there.col(k - 1);
  return {there * coefficients, slope};
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
  const auto residual = [&](const VectorXd& x) {
    const VectorXd w = x.head(n), u = x.tail(c), added = K * (w.array() - gap).cwiseMax(0).matrix() - K * w;
    VectorXd r(n + c);
    r << w + radial_by_p * added - motion * u,
        (S * u + motion.transpose() * points.weight.cwiseProduct(added) + held.cwiseProduct(u) - load) / K;
    return r;
  };
  VectorXd x = VectorXd::Zero(n + c);  // w at the points, displacements
  constexpr int most = 100;
  for (int step = 0; step < most; ++step) {
    const VectorXd w = x.head(n), u = x.tail(c), r = residual(x);
    const auto touches = (w.array() > gap).eval();
    const VectorXd pressure = K * touches.select(w.array() - gap, 0), added = pressure - K * w;
    constexpr double rounding = 1e-9;
    if (r.lpNorm<Eigen::Infinity>() < rounding * x.lpNorm<Eigen::Infinity>()) {
      const VectorXd u_n = radial * u + radial_by_p * added, u_t = along * u + along_by_p * added;
      const rim::RimCompliance sheet(plate.scene.elasticity[plate.mesh.mesh.material[rim.sides[0].element]].inverse(),
                                     rim.radius);
      Peaks peaks{-HUGE_VAL, pressure.maxCoeff()};
      for (const auto& [first, count] : points.sides) {  // between the points too, where the end of contact may lie
        VectorXd at(count);
        for (Index i = 0; i < count; ++i) at[i] = rim::wrapped(points.angle[first + i] - points.angle[first]);
        constexpr int dense = 2000;
        const VectorXd places = VectorXd::LinSpaced(dense, at.minCoeff(), at.maxCoeff());
        const auto [normal_there, normal_slope] = interpolated(at, u_n.segment(first, count), places, p);
        const auto [along_there, along_slope] = interpolated(at, u_t.segment(first, count), places, p);
        for (Index i = 0; i < dense; ++i) {
          const double angle = points.angle[first] + places[i];
          const double depth = u[c - 2] * std::cos(angle) + u[c - 1] * std::sin(angle) - normal_there[i] - gap;
          const Eigen::Vector3d by = sheet.along(angle);
          const double strain = (along_slope[i] + normal_there[i]) / rim.radius;
          peaks.hoop = std::max(peaks.hoop, (strain + by[0] * K * std::max(depth, 0.0)) / by[1]);
        }
      }
      return peaks;
    }
    const VectorXd fall = K * (touches.cast<double>() - 1);
    MatrixXd J(n + c, n + c);
    J << MatrixXd::Identity(n, n) + radial_by_p * fall.asDiagonal(), -motion,
        motion.transpose() * points.weight.cwiseProduct(fall).asDiagonal() / K, (S + MatrixXd(held.asDiagonal())) / K;
    constexpr int whole_steps = 30;  // then half ones, where points come to touch and cease to by turns
    x -= (step < whole_steps ? 1 : 0.5) * J.partialPivLu().solve(r);
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
