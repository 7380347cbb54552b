// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/contact/rim_gap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "common/count.hpp"
#include "common/pfem/shape_functions.hpp"

namespace fastjoint::stage1 {
namespace {

constexpr double touching = 1e-9;  // radians: ends of neighbouring sides differ by rounding only

/// The degrees of freedom of modes of the side's element.
pfem::ElementDofs dofs_of(const PlateProblem& problem, const pfem::Side& side, const std::vector<int>& modes) {
  return pfem::element_dofs(problem.numbering, problem.unknowns.dofs, side.element, modes);
}

/// The zero of f between low and high, where its signs differ, to rounding.
template <class Function>
double bisect(const Function& f, double low, double high) {
  constexpr double exact = 1e-13;
  const bool positive_at_low = f(low) > 0;
  while (high - low > exact) {
    const double middle = (low + high) / 2;
    ((f(middle) > 0) == positive_at_low ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// The largest value of f between low and high, where it has one hump: golden section.
template <class Function>
double highest(const Function& f, double low, double high) {
  const double golden = (std::sqrt(5.0) - 1) / 2;
  constexpr double fine = 1e-9;  // near its top f changes by the square of this
  while (high - low > fine) {
    const double a = high - golden * (high - low);
    const double b = low + golden * (high - low);
    f(a) > f(b) ? high = b : low = a;
  }
  return (low + high) / 2;
}

}  // namespace

Arcs joined(std::vector<rim::AngleRange> pieces) {
  for (auto& piece : pieces) {
    const double length = piece.to - piece.from;
    piece.from = rim::wrapped(piece.from + touching) - touching;  // an end at pi is one at -pi
    piece.to = piece.from + length;
  }
  std::sort(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
  Arcs arcs;
  for (const auto& piece : pieces) {
    if (!arcs.empty() && piece.from - arcs.back().to < touching)
      arcs.back().to = piece.to;
    else
      arcs.push_back(piece);
  }
  if (arcs.empty()) return arcs;
  if (arcs.size() == 1 && arcs[0].to - arcs[0].from > rim::full_turn - touching) return whole_rim;
  if (arcs.size() > 1 && arcs.front().from + rim::full_turn - arcs.back().to < touching) {
    arcs.back().to = arcs.front().to + rim::full_turn;
    arcs.erase(arcs.begin());
  }
  return arcs;
}

double largest_move(const Arcs& before, const Arcs& after) {
  if (before.size() != after.size()) return std::numeric_limits<double>::infinity();
  double move = 0;
  for (const auto& arc : after) {
    double nearest = std::numeric_limits<double>::infinity();  // an arc moved over pi changes its place in the list
    for (const auto& old : before)
      nearest = std::min(
          nearest, std::max(std::abs(rim::wrapped(arc.from - old.from)), std::abs(rim::wrapped(arc.to - old.to))));
    move = std::max(move, nearest);
  }
  return move;
}

int RimUnknowns::index(int dof) const {
  if (dof == pfem::fixed_dof) return -1;
  return pfem::is_free(dof) ? index_in_free[dof] : count_of(free) + pfem::controlled_index(dof);
}

RimUnknowns find_rim_unknowns(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem) {
  RimUnknowns unknowns{{}, {}, problem.unknowns.n_controlled()};
  unknowns.index_in_free.assign(problem.unknowns.n_free.back(), -1);
  std::set<int> on_rim;
  for (std::size_t hole = 0; hole < scene.holes.size(); ++hole) {
    if (!scene.holes[hole].spring || !scene.holes[hole].spring->compression_only) continue;
    for (const auto& side : plate.rims[hole].sides)
      for (const int dof : dofs_of(problem, side, pfem::modes_on_edge(problem.numbering.p, side.local_edge)).dof)
        if (pfem::is_free(dof)) on_rim.insert(dof);
  }
  unknowns.free.assign(on_rim.begin(), on_rim.end());
  for (int i = 0; i < count_of(unknowns.free); ++i) unknowns.index_in_free[unknowns.free[i]] = i;
  return unknowns;
}

/// u is a polynomial of the side's coordinate s in either component, D constant, n known: g at any s.
class RimGap::Trace {
 public:
  Trace(const RimGap& rim, const pfem::Side& side, const Eigen::VectorXd& z)
      : curve_(pfem::edge_curve(rim.plate_.mesh, rim.plate_.edges, side.element, side.local_edge)),
        p_(rim.problem_.numbering.p),
        u_(Eigen::Matrix2Xd::Zero(2, p_ + 1)),
        disc_(Eigen::Vector2d::Zero()) {
    const auto [dof, sign] = dofs_of(rim.problem_, side, pfem::modes_on_edge(p_, side.local_edge));
    for (Eigen::Index i = 0; i < dof.size(); ++i)
      if (const int index = rim.unknowns_.index(dof[i]); index >= 0)
        u_(i / (p_ + 1), i % (p_ + 1)) = sign[i] * z[index];
    const Unknowns& unknowns = rim.problem_.unknowns;
    const int first_disc = unknowns.disc_of_hole[rim.hole_];
    for (int a = 0; a < unknowns.n_directions; ++a) {
      const int controlled = unknowns.controlled_of_disc(first_disc + a);
      disc_ += z[rim.unknowns_.index(pfem::controlled_dof(controlled))] * rim::axis(rim.scene_.disc_directions[a]);
    }
  }

  [[nodiscard]] double angle(double s) const { return curve_.start_angle() + (1 + s) / 2 * curve_.sweep(); }
  double operator()(double s) const {
    const Eigen::Vector2d u = u_ * pfem::integrated_legendre(p_, Eigen::VectorXd::Constant(1, s)).N;
    return (disc_ - u).dot(Eigen::Vector2d(std::cos(angle(s)), std::sin(angle(s))));
  }
  [[nodiscard]] rim::AngleRange range(double s_from, double s_to) const {
    const double a = angle(s_from);
    const double b = angle(s_to);
    return {std::min(a, b), std::max(a, b)};
  }
  /// Places on [-1, 1] so close that a polynomial of degree p times a sine hardly changes its sign twice in between.
  [[nodiscard]] Eigen::VectorXd samples() const { return Eigen::VectorXd::LinSpaced(8 * (p_ + 1) + 1, -1, 1); }

 private:
  pfem::Curve curve_;
  int p_;
  Eigen::Matrix2Xd u_;
  Eigen::Vector2d disc_;
};

RimGap::RimGap(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem,
               const RimUnknowns& unknowns, int hole)
    : scene_(scene), plate_(plate), problem_(problem), unknowns_(unknowns), hole_(hole) {}

RimGap::SideGap RimGap::side_gap(const pfem::Side& side, const pfem::SideRule& rule) const {
  const auto n_points = rule.ds.size();
  std::vector<Eigen::RowVectorXd> rows;
  SideGap gap;
  const auto [dof, sign] = dofs_of(problem_, side, rule.modes);
  const int n = count_of(rule.modes);
  for (Eigen::Index i = 0; i < dof.size(); ++i) {
    const int index = unknowns_.index(dof[i]);
    if (index < 0) continue;
    gap.index.push_back(index);
    rows.emplace_back(sign[i] * rule.N.row(i % n).cwiseProduct(rule.normal.row(i / n)));
  }
  const int first_disc = problem_.unknowns.disc_of_hole[hole_];
  for (int a = 0; a < problem_.unknowns.n_directions; ++a) {
    const int controlled = problem_.unknowns.controlled_of_disc(first_disc + a);
    gap.index.push_back(unknowns_.index(pfem::controlled_dof(controlled)));
    rows.emplace_back(-rim::axis(scene_.disc_directions[a]).transpose() * rule.normal);
  }
  gap.a.resize(rows.size(), n_points);
  for (std::size_t i = 0; i < rows.size(); ++i) gap.a.row(i) = rows[i];
  return gap;
}

Eigen::MatrixXd RimGap::stiffness(const Arcs& arcs) const {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(unknowns_.size(), unknowns_.size());
  Spring spring = scene_.holes[hole_].sprung();
  spring.acts = arcs;
  for (const auto& side : plate_.rims[hole_].sides) {
    const plate::SideSprings springs =
        plate::side_springs(spring, plate_.mesh, plate_.edges, side, problem_.numbering.p);
    const SideGap gap = side_gap(side, springs.rule);
    const Eigen::MatrixXd K = gap.a * springs.weight.asDiagonal() * gap.a.transpose();
    M(gap.index, gap.index) += K;
  }
  return M;
}

Arcs RimGap::pressed(const Eigen::VectorXd& z) const {
  std::vector<rim::AngleRange> pieces;
  for (const auto& side : plate_.rims[hole_].sides) {
    const Trace g(*this, side, z);
    const Eigen::VectorXd s = g.samples();
    double from = -1;
    bool positive = g(from) > 0;
    for (Eigen::Index i = 0; i + 1 < s.size(); ++i) {
      if ((g(s[i + 1]) > 0) == positive) continue;
      const double zero = bisect(g, s[i], s[i + 1]);
      if (positive) pieces.push_back(g.range(from, zero));
      positive = !positive;
      from = zero;
    }
    if (positive) pieces.push_back(g.range(from, 1));
  }
  Arcs arcs = joined(std::move(pieces));
  constexpr double point = 1e-9;  // radians: what rounding can lift above zero
  std::erase_if(arcs, [](const rim::AngleRange& arc) { return arc.to - arc.from < point; });
  return arcs;
}

Arcs RimGap::bearing_half(const Eigen::Vector2d& d) const {
  const double middle = std::atan2(d.y(), d.x());
  const double quarter = rim::full_turn / 4;
  std::vector<rim::AngleRange> pieces;
  for (const auto& side : plate_.rims[hole_].sides) {
    const auto curve = pfem::edge_curve(plate_.mesh, plate_.edges, side.element, side.local_edge);
    const double a = rim::wrapped(std::min(curve.start_angle(), curve.start_angle() + curve.sweep()) - middle);
    const double b = a + std::abs(curve.sweep());
    for (const double turn : {0.0, rim::full_turn}) {  // the side may run over the direction opposite to d
      const double from = std::max(a - turn, -quarter);
      const double to = std::min(b - turn, quarter);
      if (to > from) pieces.push_back({from + middle, to + middle});
    }
  }
  return joined(std::move(pieces));
}

std::vector<double> RimGap::ends() const {
  std::vector<rim::AngleRange> pieces;
  for (const auto& side : plate_.rims[hole_].sides)
    pieces.push_back(Trace(*this, side, Eigen::VectorXd::Zero(unknowns_.size())).range(-1, 1));
  const Arcs rim = joined(std::move(pieces));
  std::vector<double> ends;
  for (const auto& arc : rim)
    if (arc.to - arc.from < rim::full_turn) ends.insert(ends.end(), {arc.from, arc.to});
  return ends;
}

RimGap::Peak RimGap::peak(const Eigen::VectorXd& z) const {
  Peak best{-std::numeric_limits<double>::infinity(), 0};
  for (const auto& side : plate_.rims[hole_].sides) {
    const Trace g(*this, side, z);
    const Eigen::VectorXd s = g.samples();
    Eigen::Index top = 0;
    s.unaryExpr(g).maxCoeff(&top);
    const double inside = highest(g, s[std::max<Eigen::Index>(top - 1, 0)], s[std::min(top + 1, s.size() - 1)]);
    for (const double at : {s[top], inside})  // the top may be an end, which golden section only approaches
      if (g(at) > best.gap) best = {g(at), rim::wrapped(g.angle(at))};
  }
  return best;
}

}  // namespace fastjoint::stage1
