// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <utility>

#include "common/infinite.hpp"
#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {
namespace {

/// Corner of a piecewise linear curve.
struct Vertex {
  double delta, F;  ///< length, force
};

/// Piecewise linear curve: from (0, 0) through its vertices, then on with a last slope.
struct Polyline {
  std::vector<Vertex> vertices;  ///< neither delta nor F falls
  double last_slope;             ///< force / length, >= 0; infinite for a rigid law
};

/// Parameter of the input and the derivative of the curve by it.
struct PolylineParameter {
  Parameter parameter;
  Polyline derivative;  ///< of every vertex and of the last slope
};

/// A branch that remembers: open up to a gap, then a stiffness, in series with a slider that moves at a limit.
struct LinearBranch {
  double gap, k, limit, k_yield;  ///< length, force / length, force, slope of the branch while the slider moves
  bool takes_clearance, is_slip;
};

MemoryBranch memory_branch(const LinearBranch& branch, double clearance) {
  const double k = branch.k, gap = branch.gap + (branch.takes_clearance ? clearance : 0);
  const double hardening = branch.k_yield < k ? k * branch.k_yield / (k - branch.k_yield) : infinite;
  return {.elastic =
              [=](double x) {
                return x > gap ? Rise{k * (x - gap), k} : Rise{0, gap > 0 ? 0 : k};
              },
          .backstress =
              [=](double s) {
                return hardening < infinite ? Rise{hardening * s, hardening} : Rise{0, 0};
              },
          .limit = hardening < infinite ? branch.limit : infinite,  // a slope that does not fall is no yield
          .is_slip = branch.is_slip};
}

/// Law that is linear between corners.
class PiecewiseLinearLaw final : public Law {
 public:
  /// @param first_moved The clearance moves the vertices from this one on along delta.
  PiecewiseLinearLaw(Polyline curve, std::size_t first_moved, std::vector<PolylineParameter> parameters,
                     std::optional<Source> source, std::vector<LinearBranch> branches)
      : curve_(std::move(curve)),
        first_moved_(first_moved),
        parameters_(std::move(parameters)),
        source_(std::move(source)),
        branches_(std::move(branches)) {}

  [[nodiscard]] Branch at(double c, double k, double clearance) const override {
    const Piece on = piece(c, k, clearance);
    return {
        .F = on.F + on.dF * (c - on.c), .delta = on.delta + on.ddelta * (c - on.c), .dF = on.dF, .ddelta = on.ddelta};
  }

  [[nodiscard]] double coordinate(double F, double k, double clearance) const override {
    double c0 = 0, F0 = 0;
    for (std::size_t i = 0; i < curve_.vertices.size(); ++i) {
      const Vertex v = vertex(i, clearance);
      const double c1 = v.F + k * v.delta;
      if (F < v.F) return c0 + (F - F0) / (v.F - F0) * (c1 - c0);
      c0 = c1;
      F0 = v.F;
    }
    // A curve with a last slope of zero does not reach F, and the last corner is returned.
    return curve_.last_slope > 0 ? c0 + (F - F0) * (1 + k / curve_.last_slope) : c0;
  }

  [[nodiscard]] double max_force() const override {
    return curve_.last_slope > 0 ? infinite : curve_.vertices.back().F;
  }

  [[nodiscard]] double gap(double clearance) const override { return vertex(first_moved_, clearance).delta; }

  [[nodiscard]] std::optional<std::vector<double>> corners(double k, double clearance) const override {
    std::vector<double> result;
    for (std::size_t i = 0; i < curve_.vertices.size(); ++i) {
      const Vertex v = vertex(i, clearance);
      const double c = v.F + k * v.delta;
      if (c > (result.empty() ? 0 : result.back())) result.push_back(c);
    }
    return result;
  }

  [[nodiscard]] std::vector<Parameter> parameters() const override {
    std::vector<Parameter> result;
    for (const auto& each : parameters_) result.push_back(each.parameter);
    return result;
  }

  [[nodiscard]] std::vector<Slope> slopes(double c, double k, double clearance) const override {
    const Piece on = piece(c, k, clearance);
    Polyline moved{std::vector<Vertex>(curve_.vertices.size(), {0, 0}), 0};
    for (std::size_t i = first_moved_; i < moved.vertices.size(); ++i) moved.vertices[i].delta = 1;
    const auto slope = [&](const Polyline& derivative) {
      const double F = force_slope(on, c, k, clearance, derivative);
      return Slope{F, -F / k};
    };
    std::vector<Slope> result{slope(moved)};
    for (const auto& each : parameters_) result.push_back(slope(each.derivative));
    return result;
  }

  [[nodiscard]] std::optional<Source> source() const override { return source_; }

  [[nodiscard]] std::vector<MemoryBranch> branches(double clearance) const override {
    std::vector<MemoryBranch> result;
    for (const auto& branch : branches_) result.push_back(memory_branch(branch, clearance));
    return result;
  }

 private:
  /// Piece of the curve in terms of c, from its first point on.
  struct Piece {
    std::size_t end;  ///< vertex at its end; number of vertices after the last
    double c, F, delta, dF, ddelta;
  };

  [[nodiscard]] Vertex vertex(std::size_t i, double clearance) const {
    const Vertex& v = curve_.vertices[i];
    return {v.delta + (i >= first_moved_ ? clearance : 0), v.F};
  }

  [[nodiscard]] Piece piece(double c, double k, double clearance) const {
    double c0 = 0;
    Vertex start{0, 0};
    for (std::size_t i = 0; i < curve_.vertices.size(); ++i) {
      const Vertex end = vertex(i, clearance);
      const double c1 = end.F + k * end.delta;
      if (c < c1)
        return {i, c0, start.F, start.delta, (end.F - start.F) / (c1 - c0), (end.delta - start.delta) / (c1 - c0)};
      c0 = c1;
      start = end;
    }
    const double sum = curve_.last_slope + k;
    const double dF = sum < infinite ? curve_.last_slope / sum : 1;
    return {curve_.vertices.size(), c0, start.F, start.delta, dF, 1 / sum};
  }

  /// Derivative of F at fixed c by a parameter for which the curve has `derivative`.
  [[nodiscard]] double force_slope(const Piece& piece, double c, double k, double clearance,
                                   const Polyline& derivative) const {
    const Vertex start = piece.end > 0 ? derivative.vertices[piece.end - 1] : Vertex{0, 0};
    double rate_slope = 0;
    if (piece.end == curve_.vertices.size()) {
      const double sum = curve_.last_slope + k;
      rate_slope = derivative.last_slope * k / (sum * sum);
    } else {
      const Vertex end = derivative.vertices[piece.end];
      const Vertex v = vertex(piece.end, clearance);
      const double length = v.F + k * v.delta - piece.c;
      rate_slope = ((end.F - start.F) * (1 - piece.dF) - piece.dF * k * (end.delta - start.delta)) / length;
    }
    return start.F - (start.F + k * start.delta) * piece.dF + (c - piece.c) * rate_slope;
  }

  Polyline curve_;
  std::size_t first_moved_;
  std::vector<PolylineParameter> parameters_;
  std::optional<Source> source_;
  std::vector<LinearBranch> branches_;  ///< none of a law without memory
};

/// @param branches Of a law that remembers.
LawPointer piecewise_linear_law(Polyline curve, std::size_t first_moved, std::vector<PolylineParameter> parameters,
                                std::optional<Source> source = std::nullopt, std::vector<LinearBranch> branches = {}) {
  return std::make_shared<PiecewiseLinearLaw>(std::move(curve), first_moved, std::move(parameters), std::move(source),
                                              std::move(branches));
}

/// True if a law is asked to unload along its loading curve.
bool is_reversible(const input::Value& law) {
  const auto reversible = law.find("reversible");
  return reversible && reversible->boolean();
}

/// Slope after yield of a law that remembers, which must not be more than that before.
double read_k_yield(const input::Value& law, double k, const char* name_of_k) {
  const auto value = law.at("k_yield");
  const double k_yield = value.number(input::not_negative);
  if (!is_reversible(law) && k_yield > k)
    value.fail(
        fmt::format("{}", k_yield),
        fmt::format("at most {} = {}, or \"reversible\": true, since a law that stiffens keeps no set", name_of_k, k));
  return k_yield;
}

}  // namespace

LawPointer linear_law(double k, std::optional<Source> source) {
  return piecewise_linear_law({{{0, 0}}, k}, 0, {{{"k", -1, 1}, {{{0, 0}}, 1}}}, std::move(source));
}

/// Reads {"type": "linear", "k": force / length}.
LawPointer read_linear_law(const input::Value& law) {
  law.only({"type", "k", "one_sided"});
  return linear_law(law.at("k").number(input::positive), std::nullopt);
}

/// Reads {"type": "rigid"}: any force without displacement.
LawPointer read_rigid_law(const input::Value& law) {
  law.only({"type", "one_sided"});
  return piecewise_linear_law({{{0, 0}}, infinite}, 0, {});
}

/// Reads {"type": "bilinear", "k": ..., "F_yield": ..., "k_yield": ..., "reversible": ...}: k up to F_yield, k_yield
/// beyond, back with k unless it is reversible.
LawPointer read_bilinear_law(const input::Value& law) {
  law.only({"type", "k", "F_yield", "k_yield", "one_sided", "reversible"});
  const double k = law.at("k").number(input::positive);
  const double F = law.at("F_yield").number(input::positive);
  const double k_yield = read_k_yield(law, k, "k");
  std::vector<LinearBranch> branches;
  if (!is_reversible(law) && k_yield < k) branches = {{0, k, F, k_yield, true, false}};
  return piecewise_linear_law({{{0, 0}, {F / k, F}}, k_yield}, 0,
                              {{{"k", -1, 1}, {{{0, 0}, {-F / (k * k), 0}}, 0}},
                               {{"F_yield", 0, 1}, {{{0, 0}, {1 / k, 1}}, 0}},
                               {{"k_yield", -1, 1}, {{{0, 0}, {0, 0}}, 1}}},
                              std::nullopt, std::move(branches));
}

/// Reads {"type": "four stage", "k_stick", "F_slip", "slip", "k_bearing", "F_yield", "k_yield"}: Bortman & Szabo,
/// Figure 2.
///
/// Static friction holds up to F_slip; then the joint slips by "slip" plus the clearance, bears elastically up to
/// F_yield and yields beyond. Unless it is reversible, friction keeps its slip and acts beside the bearing, and the
/// bearing keeps its yield.
LawPointer read_four_stage_law(const input::Value& law) {
  law.only({"type", "k_stick", "F_slip", "slip", "k_bearing", "F_yield", "k_yield", "one_sided", "reversible"});
  const double k_stick = law.at("k_stick").number(input::positive);
  const double F_slip = law.at("F_slip").number(input::positive);
  const double slip = law.at("slip").number(input::not_negative);
  const double k_bearing = law.at("k_bearing").number(input::positive);
  const auto yield = law.at("F_yield");
  const double F_yield = yield.number(input::positive);
  if (!(F_yield > F_slip)) yield.fail(fmt::format("{}", F_yield), fmt::format("more than F_slip = {}", F_slip));
  const double k_yield = read_k_yield(law, k_bearing, "k_bearing");
  const double stuck = F_slip / k_stick, slipped = stuck + slip;
  const double bearing = (F_yield - F_slip) / k_bearing;
  const double d_stick = -stuck / k_stick;
  std::vector<LinearBranch> branches;
  if (!is_reversible(law))
    branches = {{0, k_stick, F_slip, 0, false, true}, {slipped, k_bearing, F_yield - F_slip, k_yield, true, false}};
  return piecewise_linear_law(
      {{{stuck, F_slip}, {slipped, F_slip}, {slipped + bearing, F_yield}}, k_yield}, 1,
      std::vector<PolylineParameter>{
          {{"k_stick", -1, 1}, {{{d_stick, 0}, {d_stick, 0}, {d_stick, 0}}, 0}},
          {{"F_slip", 0, 1}, {{{1 / k_stick, 1}, {1 / k_stick, 1}, {1 / k_stick - 1 / k_bearing, 0}}, 0}},
          {{"slip", 1, 0}, {{{0, 0}, {1, 0}, {1, 0}}, 0}},
          {{"k_bearing", -1, 1}, {{{0, 0}, {0, 0}, {-bearing / k_bearing, 0}}, 0}},
          {{"F_yield", 0, 1}, {{{0, 0}, {0, 0}, {1 / k_bearing, 1}}, 0}},
          {{"k_yield", -1, 1}, {{{0, 0}, {0, 0}, {0, 0}}, 1}}},
      std::nullopt, std::move(branches));
}

}  // namespace fastjoint::stage3
