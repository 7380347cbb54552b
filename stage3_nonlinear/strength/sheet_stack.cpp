// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/sheet_stack.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "stage3_nonlinear/strength/beam_column.hpp"

namespace fastjoint::stage3 {
namespace {

/// Displacements of nodes, w and w' of each, of which some are equal and some 0.
class Motions {
 public:
  explicit Motions(const SheetStack& stack) {
    for (const auto& sheet : stack.sheets) {
      first_.push_back(std::ssize(parent_));
      parent_.resize(parent_.size() + 2 * sheet.at.size());
    }
    std::iota(parent_.begin(), parent_.end(), 0);
    ground_ = std::ssize(parent_);
    parent_.push_back(ground_);
  }

  /// Number of w, or of w', of a node.
  [[nodiscard]] Index w(Index sheet, Index node) const { return first_[sheet] + 2 * node; }
  [[nodiscard]] Index slope(Index sheet, Index node) const { return w(sheet, node) + 1; }
  /// That which is always 0.
  [[nodiscard]] Index ground() const { return ground_; }
  void join(Index a, Index b) {
    a = root(a), b = root(b);
    parent_[std::min(a, b)] = std::max(a, b);  // so that the ground stays a root
  }
  /// Unknown of each displacement, -1 for 0, and the number of unknowns.
  [[nodiscard]] std::pair<std::vector<Index>, Index> numbered() const {
    std::vector<Index> number(parent_.size(), -1);
    Index n = 0;
    for (Index i = 0; i < ground_; ++i)
      if (root(i) == i) number[i] = n++;
    for (Index i = 0; i < ground_; ++i) number[i] = number[root(i)];
    return {number, n};
  }

 private:
  [[nodiscard]] Index root(Index i) const {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }

  std::vector<Index> first_, parent_;
  Index ground_;
};

/// The stack with some links clamped.
class BentStack {
 public:
  BentStack(const SheetStack& stack, const StackLoads& loads) : stack_(stack), loads_(loads) {
    for (const auto& N : loads.N) is_known_ = is_known_ && N.allFinite();
  }

  [[nodiscard]] StackShape solve(const std::vector<bool>& clamped) const {
    Motions motions(stack_);
    hold(clamped, motions);
    const auto [number, n] = motions.numbered();
    MatrixXd K = MatrixXd::Zero(n + 1, n + 1);  // the last takes what is held
    VectorXd f = VectorXd::Zero(n + 1);
    const auto at = [&, n = n, &number = number](Index displacement) {
      return number[displacement] < 0 ? n : number[displacement];
    };
    for (Index i = 0; i < std::ssize(stack_.sheets); ++i)
      for (Index s = 0; s < stack_.sheets[i].EI.size(); ++s) {
        const Eigen::Matrix4d k = beam(i, s).stiffness();
        const Index first = motions.w(i, s);
        for (int a = 0; a < 4; ++a)
          for (int b = 0; b < 4; ++b) K(at(first + a), at(first + b)) += k(a, b);
      }
    for (Index j = 0; j < std::ssize(stack_.links); ++j) {
      const StackLink& link = stack_.links[j];
      // The forces act on the faces, half a thickness above and below the middles of the sheets.
      f[at(motions.slope(link.lower, lower_node(link)))] -=
          loads_.q[j] * stack_.sheets[link.lower].thickness_at(link.lower_row) / 2;
      if (link.upper >= 0)
        f[at(motions.slope(link.upper, upper_node(link)))] -=
            loads_.q[j] * stack_.sheets[link.upper].thickness_at(link.upper_row) / 2;
    }
    StackShape shape;
    const VectorXd u = solved(K.topLeftCorner(n, n), f.head(n), shape.buckles);
    VectorXd all(std::ssize(number) - 1);
    for (Index i = 0; i < all.size(); ++i) all[i] = number[i] < 0 ? 0 : u[number[i]];
    describe(all, motions, shape);
    shape.buckles = shape.buckles || bay_buckles();
    return shape;
  }

  [[nodiscard]] bool is_known() const { return is_known_; }
  /// Links at which free heads would press one sheet into the other.
  [[nodiscard]] std::vector<bool> pressed(const StackShape& shape, double steepest) const {
    constexpr double rounding = 1e-9, gives_way = 0.25;
    std::vector<bool> all;
    for (const auto& link : stack_.links) {
      bool is_pressed = false;
      const double lower = shape.slope[link.lower][lower_node(link)];
      const double upper = link.upper < 0 ? 0 : shape.slope[link.upper][upper_node(link)];
      for (const int side : {0, 1}) {
        if (stack_.sheets[link.lower].beside(lower_node(link), side) < 0) continue;
        if (link.upper >= 0 && stack_.sheets[link.upper].beside(upper_node(link), side) < 0) continue;
        const double sign = side == 0 ? -1 : 1;
        const double towards = std::max(0.0, sign * lower) + std::max(0.0, -sign * upper);
        const double closes = sign * (lower - upper);
        is_pressed = is_pressed || (towards > rounding * steepest && closes > (1 - gives_way) * towards);
      }
      all.push_back(is_pressed);
    }
    return all;
  }

 private:
  [[nodiscard]] Index lower_node(const StackLink& link) const { return stack_.sheets[link.lower].rows[link.lower_row]; }
  [[nodiscard]] Index upper_node(const StackLink& link) const { return stack_.sheets[link.upper].rows[link.upper_row]; }
  [[nodiscard]] BeamColumn beam(Index sheet, Index segment) const {
    const StackSheet& its = stack_.sheets[sheet];
    return {its.EI[segment], is_known_ ? loads_.N[sheet][segment] : 0, its.at[segment + 1] - its.at[segment]};
  }
  void hold(const std::vector<bool>& clamped, Motions& motions) const {
    for (Index i = 0; i < std::ssize(stack_.sheets); ++i)
      for (const int end : {0, 1}) {
        const EndHold how = stack_.sheets[i].ends[end];
        const Index node = end == 0 ? 0 : stack_.sheets[i].at.size() - 1;
        if (how == EndHold::hinged || how == EndHold::clamped) motions.join(motions.w(i, node), motions.ground());
        if (how == EndHold::symmetric || how == EndHold::clamped)
          motions.join(motions.slope(i, node), motions.ground());
      }
    for (Index j = 0; j < std::ssize(stack_.links); ++j) {
      const StackLink& link = stack_.links[j];
      const Index lower = motions.w(link.lower, lower_node(link));
      const Index upper = link.upper < 0 ? motions.ground() : motions.w(link.upper, upper_node(link));
      motions.join(lower, upper);
      if (clamped[j]) motions.join(lower + 1, link.upper < 0 ? upper : upper + 1);
    }
  }

  /// True if a bay buckles between its ends even if these are clamped, which no eigenvalue of the exact stiffness tells
  /// (W. H. Wittrick, F. W. Williams, A general algorithm for computing natural frequencies of elastic structures,
  /// Q. J. Mech. Appl. Math. 24, 1971).
  [[nodiscard]] bool bay_buckles() const {
    constexpr double pi = std::numbers::pi;
    for (Index i = 0; i < std::ssize(stack_.sheets); ++i)
      for (Index k = 0; k < stack_.sheets[i].EI.size(); ++k)
        if (const BeamColumn its = beam(i, k); - its.N * its.length * its.length >= 4 * pi * pi * its.EI) return true;
    return false;
  }

  /// Solution of a system that may be free to move, by eigenvectors: none of a motion without stiffness, which no force
  /// drives, and of a negative stiffness.
  static VectorXd solved(const MatrixXd& K, const VectorXd& f, bool& buckles) {
    if (f.size() == 0) return f;
    constexpr double rounding = 1e-11;  // of stiffnesses scaled to 1 on the diagonal
    const VectorXd scale =
        K.diagonal().cwiseAbs().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(scale.asDiagonal() * K * scale.asDiagonal());
    const VectorXd& values = eigen.eigenvalues();
    buckles = values[0] < -rounding;
    if (buckles) return VectorXd::Zero(f.size());
    VectorXd parts = eigen.eigenvectors().transpose() * scale.cwiseProduct(f);
    for (Index i = 0; i < parts.size(); ++i) parts[i] = values[i] > rounding ? parts[i] / values[i] : 0;
    return scale.cwiseProduct(eigen.eigenvectors() * parts);
  }

  /// Sets what follows from the displacements.
  void describe(const VectorXd& u, const Motions& motions, StackShape& shape) const {
    for (Index i = 0; i < std::ssize(stack_.sheets); ++i) {
      const StackSheet& sheet = stack_.sheets[i];
      const Index s = sheet.EI.size();
      const auto its = u.segment(motions.w(i, 0), 2 * (s + 1)).reshaped(2, s + 1);
      shape.w.emplace_back(its.row(0));
      shape.slope.emplace_back(its.row(1));
      VectorXd& shortened = shape.shortened.emplace_back(VectorXd::Zero(s + 1));
      MatrixXd ends(s, 2);  // moments E I w'' at the ends of each segment
      for (Index k = 0; k < s; ++k) {
        const Eigen::Vector4d at = u.segment<4>(motions.w(i, k));
        const Eigen::Vector4d forces = beam(i, k).stiffness() * at;
        ends.row(k) << -forces[1], forces[3];
        shortened[k + 1] = shortened[k] + at.dot(beam(i, k).by_tension() * at) / 2;
      }
      MatrixXd& moment = shape.moment.emplace_back(MatrixXd::Zero(s + 1, 2));
      moment.block(1, 0, s, 1) = ends.col(1);
      moment.block(0, 1, s, 1) = ends.col(0);
    }
  }

  const SheetStack& stack_;
  const StackLoads& loads_;
  bool is_known_ = true;
};

}  // namespace

Index StackSheet::beside(Index node, int side) const {
  const Index segment = node - 1 + side;
  return segment < EI.size() ? segment : -1;
}

double StackSheet::thickness_at(Index row) const {
  const Index before = std::max<Index>(rows[row] - 1, 0), behind = std::min(rows[row], thickness.size() - 1);
  return (thickness[before] + thickness[behind]) / 2;
}

StackShape SheetStack::bend(const StackLoads& loads, bool clamped_heads) const {
  const BentStack stack(*this, loads);
  std::vector<bool> clamped(links.size(), clamped_heads);
  StackShape shape = stack.solve(clamped);
  double steepest = 0;
  for (const auto& slope : shape.slope) steepest = std::max(steepest, slope.lpNorm<Eigen::Infinity>());
  while (!clamped_heads && !shape.buckles) {
    const auto pressed = stack.pressed(shape, steepest);
    bool is_new = false;
    for (std::size_t j = 0; j < clamped.size(); ++j)
      if (pressed[j] && !clamped[j]) clamped[j] = is_new = true;
    if (!is_new) break;
    shape = stack.solve(clamped);
  }
  shape.pressed = clamped_heads ? std::vector<bool>(links.size(), false) : clamped;
  // Without known tension the sheets have none here, which does not matter where they stay straight.
  double lever = 0, largest = 0;
  for (std::size_t j = 0; j < links.size(); ++j)
    lever = std::max(lever, std::abs(loads.q[Index(j)]) * sheets[links[j].lower].thickness_at(links[j].lower_row));
  for (const auto& moment : shape.moment) largest = std::max(largest, moment.lpNorm<Eigen::Infinity>());
  constexpr double rounding = 1e-9;
  shape.is_known = stack.is_known() || largest <= rounding * lever;
  if (shape.is_known && !shape.buckles) return shape;
  for (auto* parts : {&shape.w, &shape.slope, &shape.shortened})
    for (auto& each : *parts) each.setConstant(std::nan(""));
  for (auto& each : shape.moment) each.setConstant(std::nan(""));
  return shape;
}

}  // namespace fastjoint::stage3
