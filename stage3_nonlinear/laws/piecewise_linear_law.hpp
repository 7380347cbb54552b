// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {

/// A corner of a piecewise linear curve.
struct Vertex {
  double delta, F;  ///< length, force
};

/// A piecewise linear curve: from (0, 0) through its vertices, then on with a last slope.
struct Polyline {
  std::vector<Vertex> vertices;  ///< neither delta nor F falls
  double last_slope;             ///< force / length, >= 0
};

/// What a number of the input does to the curve.
struct PolylineParameter {
  Parameter parameter;
  Polyline derivative;  ///< of every vertex and of the last slope
};

/// Laws that are linear between corners, of which "linear", "bilinear" and "four stage" are the readers.
///
/// The clearance moves the vertices from `first_moved` on along delta.
class PiecewiseLinearLaw final : public Law {
 public:
  PiecewiseLinearLaw(Polyline curve, std::size_t first_moved, std::vector<PolylineParameter> parameters,
                     std::optional<Source> source = std::nullopt);
  [[nodiscard]] Branch at(double c, double k, double clearance) const override;
  [[nodiscard]] double coordinate(double F, double k, double clearance) const override;
  [[nodiscard]] double gap(double clearance) const override;
  [[nodiscard]] std::optional<std::vector<double>> kinks(double k, double clearance) const override;
  [[nodiscard]] std::vector<Parameter> parameters() const override;
  [[nodiscard]] std::vector<Slope> slopes(double c, double k, double clearance) const override;
  [[nodiscard]] std::optional<Source> source() const override { return source_; }

 private:
  /// A piece of the curve in terms of c, from its first point on.
  struct Piece {
    std::size_t end;  ///< vertex at its end; behind the last: number of vertices
    double c, F, delta, dF, ddelta;
  };
  [[nodiscard]] Vertex vertex(std::size_t i, double clearance) const;
  [[nodiscard]] Piece piece(double c, double k, double clearance) const;
  [[nodiscard]] double force_slope(const Piece& piece, double c, double k, double clearance,
                                   const Polyline& derivative) const;

  Polyline curve_;
  std::size_t first_moved_;
  std::vector<PolylineParameter> parameters_;
  std::optional<Source> source_;
};

/// {"type": "linear", "k": force / length}
[[nodiscard]] std::shared_ptr<const Law> read_linear_law(const input::Value& law);
/// A spring of stiffness k > 0.
[[nodiscard]] std::shared_ptr<const Law> linear_law(double k, std::optional<Source> source = std::nullopt);
/// {"type": "formula", ...}: a spring by a published formula (read_flexibility.hpp).
[[nodiscard]] std::shared_ptr<const Law> read_formula_law(const input::Value& law);
/// {"type": "bilinear", "k": ..., "F_yield": ..., "k_yield": ...}: k up to F_yield, k_yield beyond.
[[nodiscard]] std::shared_ptr<const Law> read_bilinear_law(const input::Value& law);
/// {"type": "four stage", "k_stick", "F_slip", "slip", "k_bearing", "F_yield", "k_yield"}: Bortman & Szabo, Figure 2.
///
/// Static friction sticks up to F_slip, the joint slips by "slip" and the fastener's clearance, bears elastically up to
/// F_yield, yields beyond.
[[nodiscard]] std::shared_ptr<const Law> read_four_stage_law(const input::Value& law);

}  // namespace fastjoint::stage3
