// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/stage3_nonlinear/exact_path.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <compare>
#include <limits>
#include <optional>
#include <set>

#include "common/matrices/decompositions.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr double rounding = 1e-12;  // relative, of solved rates and places
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A place where cells meet: a corner of a plane's curve, or b = 0 at a shared rim. Planes come first.
struct Border {
  Index at;      ///< plane, or number of planes + shared rim
  Index corner;  ///< of the plane's curve

  auto operator<=>(const Border&) const = default;
};

class Tracer {
 public:
  Tracer(const JointEquations& equations, double target)
      : joint_(equations),
        cell_(joint_.start()),
        target_(std::abs(target)),
        path_{target < 0 ? -1.0 : 1.0, {}},
        c_(VectorXd::Zero(equations.n_unknowns())),
        q_(path_.sign * equations.q_at(target)) {}

  ExactPath trace() {
    std::set<Border> tied = borders_near(c_, rounding);
    auto line = leave(tied, {});
    for (Index steps = 0; line && load_ < target_ && steps < most_steps(); ++steps) {
      const auto [end, reached] = next(*line);
      const double stop = line->loads ? std::min(end, target_) : end;
      if (!std::isfinite(stop)) break;  // at constant load nothing bears
      const bool moved = advance(*line, stop);
      if (line->loads && stop >= target_) break;
      // Corners that follow each other within rounding are left together.
      auto here = borders_near(c_, rounding);
      if (!moved) here.merge(tied);
      here.insert(reached.begin(), reached.end());
      tied = std::move(here);
      line = leave(tied, reached);
    }
    return std::move(path_);
  }

 private:
  [[nodiscard]] Index most_steps() const {
    Index n = 10 + joint_.shared_rims().size();
    for (Index j = 0; j < joint_.n_planes(); ++j) n += joint_.curve(j).corners.size();
    return 20 * n;
  }

  [[nodiscard]] bool is_plane(const Border& s) const { return s.at < joint_.n_planes(); }
  [[nodiscard]] Index rim(const Border& s) const { return s.at - joint_.n_planes(); }

  /// Borders at which c is, to a share of its largest entry.
  [[nodiscard]] std::set<Border> borders_near(const VectorXd& c, double share) const {
    std::set<Border> result;
    const double near = share * c.cwiseAbs().maxCoeff();
    for (Index j = 0; j < joint_.n_planes(); ++j)
      for (Index i = 0; i < std::ssize(joint_.curve(j).corners); ++i) {
        const bool borders = i == cell_.piece[j] || i + 1 == cell_.piece[j];
        if (borders && std::abs(c[j] - joint_.curve(j).corners[i]) <= near) result.insert({j, i});
      }
    for (const Index at : joint_.shared_rims())
      if (std::abs(joint_.rim_force(cell_, at, c, 1)) <= near) result.insert({joint_.n_planes() + at, 0});
    return result;
  }

  void flip(const Border& s) {
    if (!is_plane(s)) {
      cell_.side[rim(s)] *= -1;
    } else {
      auto& piece = cell_.piece[s.at];
      piece = piece == s.corner ? s.corner + 1 : s.corner;
      joint_.follow_signs(cell_);
    }
  }

  /// Tells whether the line leaves the cell at a border where it begins.
  [[nodiscard]] bool contradicts(const Border& s, const Line& line, double least_rate) const {
    const double rate = is_plane(s) ? line.rate[s.at] : joint_.rim_force(cell_, rim(s), line.rate, 0);
    const bool above = is_plane(s) ? cell_.piece[s.at] > s.corner : cell_.side[rim(s)] > 0;
    return (above ? -rate : rate) > least_rate;
  }

  /// The line on from here, and its cell, by least index from the cell beyond the borders reached; none if there is
  /// none, or two that both come here: the path turns.
  std::optional<Line> leave(const std::set<Border>& tied, const std::vector<Border>& reached) {
    for (const auto& s : reached) flip(s);
    const Index most_flips = 2 + 20 * tied.size();
    for (Index flips = 0; flips < most_flips; ++flips) {
      auto line = line_in_cell();
      if (!line) return std::nullopt;
      const double least_rate = rounding * line->rate.cwiseAbs().maxCoeff();
      const auto wrong = std::ranges::find_if(tied, [&](const Border& s) { return contradicts(s, *line, least_rate); });
      if (wrong == tied.end()) return line;
      flip(*wrong);
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<Line> line_in_cell() {
    constexpr double singular = 1e-13;
    const auto [J, offset] = joint_.equations(cell_);
    const matrices::Lu lu(J);
    if (lu.rcond() * std::min(1.0, lu.norm()) > singular) return Line{lu.solve(-offset), lu.solve(q_)};
    return line_without_stiffness(J);
  }

  /// Line where some motion meets no stiffness: the shortest way that balances the load, or else that motion itself, in
  /// the sense of the load.
  [[nodiscard]] std::optional<Line> line_without_stiffness(const MatrixXd& J) const {
    constexpr double balanced = 1e-9;
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> shortest;
    shortest.setThreshold(rounding);
    shortest.compute(J);
    const VectorXd rate = shortest.solve(q_);
    if ((J * rate - q_).norm() <= balanced * q_.norm()) return Line{c_ - load_ * rate, rate};
    // The rest of the load, projected on the motions without stiffness, drives them (docs/theory.md, section 8.6).
    const VectorXd left = q_ - J * rate;
    const VectorXd motion = left - shortest.solve(J * left);
    if (!(motion.norm() > balanced * left.norm())) return std::nullopt;
    return Line{c_, motion, false};
  }

  /// Parameter at which the line ends, and the borders there.
  [[nodiscard]] std::pair<double, std::vector<Border>> next(const Line& line) const {
    const double now = line.loads ? load_ : 0;
    const double least_rate = rounding * line.rate.cwiseAbs().maxCoeff();
    double end = infinity;
    std::vector<Border> reached;
    const auto meet = [&](double t, const Border& s) {
      if (!(t < end)) return;
      end = std::max(t, now);
      reached.assign(1, s);
    };
    for (Index j = 0; j < joint_.n_planes(); ++j) {
      const double rate = line.rate[j];
      const auto& corners = joint_.curve(j).corners;
      const Index piece = cell_.piece[j];
      const bool up = rate > 0;
      if (std::abs(rate) <= least_rate || (up ? piece == std::ssize(corners) : piece == 0)) continue;
      const Index corner = up ? piece : piece - 1;
      meet((corners[corner] - line.offset[j]) / rate, {j, corner});
    }
    for (const Index at : joint_.shared_rims()) {
      const double rate = joint_.rim_force(cell_, at, line.rate, 0);
      if (cell_.side[at] * rate < -least_rate)
        meet(-joint_.rim_force(cell_, at, line.offset, 1) / rate, {joint_.n_planes() + at, 0});
    }
    return {end, reached};
  }

  /// Goes along the line; true if that is further than rounding.
  bool advance(const Line& line, double t) {
    const double now = line.loads ? load_ : 0;
    const bool moved = t - now > rounding * t;
    c_ = line.offset + t * line.rate;
    if (line.loads && t > load_) {
      path_.pieces.push_back({load_, t, line.offset, line.rate});
      load_ = t;
    }
    return moved;
  }

  PiecewiseJoint joint_;
  Cell cell_;
  double target_;
  ExactPath path_;
  VectorXd c_, q_;
  double load_ = 0;  ///< |lambda|
};

}  // namespace

Index ExactPath::piece_of(double load_factor) const {
  assert(!pieces.empty());
  // The last piece also has what rounding takes beyond its end.
  return std::ranges::lower_bound(pieces.begin(), pieces.end() - 1, std::abs(load_factor), {}, &PathPiece::end) -
         pieces.begin();
}

VectorXd ExactPath::at(double load_factor) const {
  const PathPiece& piece = pieces[piece_of(load_factor)];
  return piece.offset + std::abs(load_factor) * piece.rate;
}

ExactPath exact_path(const JointEquations& equations, double target) { return Tracer(equations, target).trace(); }

VectorXd exact_forces(const JointEquations& equations, double load_factor) {
  return contact_state(equations, exact_path(equations, load_factor).at(load_factor)).F;
}

}  // namespace fastjoint::stage3
