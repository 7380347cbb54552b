// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/input/value.hpp"
#include "common/program/warning.hpp"

namespace fastjoint::stage3 {

/// A point of a fastener's curve, delta >= 0, with derivatives by the contact coordinate c.
struct Branch {
  double F;             ///< bearing force, force
  double delta;         ///< relative displacement of the discs, length
  double dF;            ///< dF / dc, dimensionless
  double ddelta;        ///< d delta / dc, length / force
  bool failed = false;  ///< past the limit load of the fastener: no solution here

  /// Point of an open fastener: F = 0 and k delta = c.
  static Branch open(double c, double k) { return {.F = 0, .delta = c / k, .dF = 0, .ddelta = 1 / k}; }
};

/// Derivatives of the point with the coordinate c by a parameter of the law, at fixed c and k.
struct Slope {
  double F;      ///< dF / d parameter
  double delta;  ///< d delta / d parameter
};

/// A parameter of a law with its name in the input; its unit is length^length force^force.
struct Parameter {
  std::string name;
  double length, force;
};

/// Origin of parameters of a law that are not in the input: a formula for these sheets and this shank.
struct Source {
  std::string text;                ///< for the summary: formula, author and publication
  bool bearing_of_plate;           ///< the bearing of the sheet is included, as in springs around a modelled hole
  std::array<double, 2> t{}, E{};  ///< of the sheets: thickness, length; Young's modulus, stress
  double d = 0;                    ///< diameter, length
  int n_shear = 1;                 ///< shear planes; with two, sheet 1 is the one in the middle
};

/// A value that rises with a length, and its slope.
struct Rise {
  double value, slope;
};
using RadialFunction = std::function<Rise(double length)>;

/// Part of a law that remembers, in parallel with the others: an elastic part in series with a slider, which moves as
/// long as the force less a backstress exceeds a limit (docs/theory.md, section 8.9).
struct MemoryBranch {
  RadialFunction elastic;     ///< force by the elastic displacement, length
  RadialFunction backstress;  ///< force by the set of the slider, length
  double limit;               ///< force > 0
  bool is_slip = false;       ///< the slider is friction that slips, else a fastener or hole that yields
};

/// Force of a fastener against the relative displacement of its discs, delta >= 0, its clearance included.
///
/// The parameter of the curve is a contact coordinate c >= 0 in force units: c = F + k delta if the law never falls,
/// else c = k delta (docs/theory.md, section 8.2). docs/developing.md describes how to add a law.
class Law {
 public:
  virtual ~Law() = default;

  /// @param c Contact coordinate, force, c >= 0.
  /// @param k Reference stiffness > 0, force / length.
  [[nodiscard]] virtual Branch at(double c, double k, double clearance) const = 0;
  /// Coordinate at which the force is approximately F > 0, for first guesses; finite for F beyond max_force() too.
  [[nodiscard]] virtual double coordinate(double F, double k, double clearance) const = 0;
  /// Displacement up to which the rim does not bear, length.
  [[nodiscard]] virtual double gap(double clearance) const { return clearance; }
  /// True if the force never falls: then the coordinate is c = F + k delta.
  [[nodiscard]] virtual bool rises() const { return true; }
  /// Upper bound of the force, which the curve reaches or approaches; infinite if there is none.
  [[nodiscard]] virtual double max_force() const { return std::numeric_limits<double>::infinity(); }
  /// Minimum of dF/ddelta, force / length; 0 if the law never falls.
  [[nodiscard]] virtual double min_slope() const { return 0; }
  /// Coordinates c > 0 at which the slope jumps, ascending, if the law is linear between them; none of a curved law,
  /// which counts as yielding as soon as it bears.
  [[nodiscard]] virtual std::optional<std::vector<double>> corners(double /*k*/, double /*clearance*/) const {
    return std::nullopt;
  }
  /// Displacement up to which the law holds, such as that of its last measured point, length; results beyond it are
  /// warned of.
  [[nodiscard]] virtual double last_delta(double /*clearance*/) const {
    return std::numeric_limits<double>::infinity();
  }
  /// The parameters of the law by which results can be differentiated.
  [[nodiscard]] virtual std::vector<Parameter> parameters() const { return {}; }
  /// Derivatives of F and delta at fixed c and k: first by the clearance, then by each of parameters(), in their order.
  [[nodiscard]] virtual std::vector<Slope> slopes(double c, double k, double clearance) const = 0;
  /// Branches of a law that keeps what has yielded or slipped; none of an elastic law. From no set they give the law's
  /// own curve.
  [[nodiscard]] virtual std::vector<MemoryBranch> branches(double /*clearance*/) const { return {}; }
  /// True if it keeps what has yielded or slipped.
  [[nodiscard]] bool remembers() const { return !branches(0).empty(); }
  [[nodiscard]] virtual std::optional<Source> source() const { return std::nullopt; }
  /// Path of the file that holds the law's points, if it has one of its own.
  [[nodiscard]] virtual std::string file() const { return {}; }
  /// Units of delta and F that this file names; empty: none.
  [[nodiscard]] virtual std::array<std::string, 2> units() const { return {}; }
  /// Warnings about the parameters, without file and place.
  [[nodiscard]] virtual std::vector<program::Warning> doubts() const { return {}; }
};

using LawPointer = std::shared_ptr<const Law>;

/// Reads {"type": ..., parameters, "one_sided": ...}; "one_sided" is left to the caller. Throws InputError.
[[nodiscard]] LawPointer read_law(const input::Value& law);

/// Spring of stiffness k > 0, force / length.
[[nodiscard]] LawPointer linear_law(double k, std::optional<Source> source);

/// Points (delta, F) of a fastener's test; length and force, neither negative.
using TestPoints = std::vector<std::array<double, 2>>;

/// Reads points in the order of the file.
///
/// The text file has two columns, separated by commas, semicolons or tabs, with decimal points, delta before F unless a
/// first line of names says otherwise; empty lines and text after a '#' are skipped. Throws InputError with file, line,
/// what was found and what is allowed; FileError if the file cannot be read.
/// @param units Takes the units of delta and F that the first line names.
[[nodiscard]] TestPoints read_points(const std::string& path, std::array<std::string, 2>* units = nullptr);

/// Root of a rising function of one variable between low and high, where it is <= 0 and >= 0: Newton's method within a
/// shrinking bracket, bisection where it leaves the bracket.
///
/// @param at x -> {value, derivative}
template <class Function>
[[nodiscard]] double rising_root(Function at, double low, double high) {
  constexpr int max_iterations = 200;
  double x = high;
  for (int i = 0; i < max_iterations && low < high; ++i) {
    const auto [value, derivative] = at(x);
    (value > 0 ? high : low) = x;
    double next = x - value / derivative;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == x || next == low || next == high) break;
    x = next;
  }
  return x;
}

}  // namespace fastjoint::stage3
