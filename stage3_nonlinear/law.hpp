// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/input/value.hpp"

namespace fastjoint::stage3 {

/// A point of a fastener's curve beyond its gap and on the loaded side, with derivatives by the coordinate s.
struct Branch {
  double F;            ///< bearing force, force
  double stretch;      ///< delta - gap, length
  double dF;           ///< dF / ds, dimensionless
  double dstretch;     ///< d stretch / ds, length / force
  bool spent = false;  ///< past all that the fastener can carry: no place for a solution
};

/// What a fastener answers to the relative displacement of its discs once the gap is closed.
///
/// The curve is given by a coordinate s >= 0 in force units, of which both F and the displacement are smooth
/// functions (theory.md section 7); which one, the law chooses. A new law is one new file and one line in
/// law.cpp.
class Law {
 public:
  Law() = default;
  Law(const Law&) = delete;
  Law& operator=(const Law&) = delete;
  virtual ~Law() = default;

  /// Gap that belongs to the law itself, length.
  [[nodiscard]] virtual double delta0() const { return 0; }
  /// @param s Coordinate, force, s >= 0.
  /// @param k Reference stiffness that turns displacements into forces, force / length.
  [[nodiscard]] virtual Branch beyond(double s, double k) const = 0;
  /// Coordinate at which the force is F >= 0, or about that: first guesses start from it.
  [[nodiscard]] virtual double coordinate(double F, double k) const = 0;
  /// Force / length, if the force is proportional to the stretch.
  [[nodiscard]] virtual std::optional<double> stiffness() const { return std::nullopt; }
  /// Stretch up to which the law was measured, length.
  [[nodiscard]] virtual double last_stretch() const { return std::numeric_limits<double>::infinity(); }
  /// What the user should know of the parameters, one sentence each.
  [[nodiscard]] virtual std::vector<std::string> doubts() const { return {}; }
};

/// Reads {"type": ..., parameters, "one_sided": ...}; "one_sided" is left to the caller. Throws InputError.
[[nodiscard]] std::shared_ptr<const Law> read_law(const input::Value& law);

}  // namespace fastjoint::stage3
