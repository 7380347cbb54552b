// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string_view>

#include "common/count.hpp"
#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {
namespace {

/// Numbers of one fastener and the sheets that it joins, for published formulas, in any consistent units.
///
/// In double shear sheet 1 is the one in the middle and sheet 2 one of the two equal straps on its sides.
struct FastenerGeometry {
  std::array<double, 2> t;  ///< thickness, length
  std::array<double, 2> E;  ///< Young's modulus of the sheets along the load, force / length^2
  double d;                 ///< diameter of the shank, length
  double E_f;               ///< Young's modulus of the fastener, force / length^2
  int n_shear = 1;          ///< shear planes: 1, or 2 if the formula covers double shear
  double nu_f = 0;          ///< Poisson's ratio of the fastener, if the formula uses it
  // Numbers of the row of fasteners, for formulas with correlations for it.
  std::array<double, 2> E_z{};      ///< Young's modulus of the sheets through the thickness, force / length^2
  double d_head = 0;                ///< diameter of the head, length
  double pitch = 0, row_pitch = 0;  ///< between fasteners of a row, between rows, length
  double rows = 0;                  ///< how many
  double c_f = 0;                   ///< factor of the kind of fastener
};

/// Flexibility by a formula, length / force: the bearing of the sheets, which springs around a modelled hole represent
/// too, and the fastener itself.
struct Flexibility {
  double of_sheets, of_fastener;
  double of_shank = 0;  ///< shear and bending of the shank alone, if the formula tells them
};

/// A published formula for the flexibility of a fastener: relative displacement of the sheets, without their own
/// elongation, per force of the whole fastener (in double shear: of both its planes together).
struct FlexibilityFormula {
  const char* name;
  Flexibility (*flexibility)(const FastenerGeometry&);
  bool knows_double_shear;
  std::vector<const char*> uses;  ///< keys of the input in addition to those that all formulas use
  const char* provenance;         ///< who, where, when
};

/// C = ((t1 + t2) / (2 d))^a b / n (1 / (t1 E1) + 1 / (n t2 E2) + 1 / (2 t1 E_f) + 1 / (2 n t2 E_f)).
///
/// This is equation (31) of LBF FB-172; its reprint in STP 927 has a misprint, n for the 2 of the third term. In double
/// shear sheet 1 is the middle one: it bears the whole load, each strap half of it.
Flexibility huth(const FastenerGeometry& g, double a, double b) {
  const double n = g.n_shear;
  const double factor = std::pow((g.t[0] + g.t[1]) / (2 * g.d), a) * b / n;
  return {factor / (g.t[0] * g.E[0]) + factor / (n * g.t[1] * g.E[1]),
          factor / (2 * g.t[0] * g.E_f) + factor / (2 * n * g.t[1] * g.E_f)};
}

Flexibility huth_bolt(const FastenerGeometry& g) { return huth(g, 2.0 / 3.0, 3.0); }
Flexibility huth_rivet(const FastenerGeometry& g) { return huth(g, 2.0 / 5.0, 2.2); }
Flexibility huth_composite(const FastenerGeometry& g) { return huth(g, 2.0 / 3.0, 4.2); }

/// C = 5 / (d E_f) + 0.8 (1 / (t1 E1) + 1 / (t2 E2)); all moduli were equal in the underlying tests.
Flexibility swift(const FastenerGeometry& g) {
  return {0.8 / (g.t[0] * g.E[0]) + 0.8 / (g.t[1] * g.E[1]), 5 / (g.d * g.E_f)};
}

/// C = sum over the sheets of 2^((t / d)^0.85) / t (1 / E + 3 / (8 E_f)).
Flexibility boeing(const FastenerGeometry& g) {
  Flexibility sum{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double factor = std::exp2(std::pow(g.t[i] / g.d, 0.85)) / g.t[i];
    sum.of_sheets += factor / g.E[i];
    sum.of_fastener += factor * 3 / (8 * g.E_f);
  }
  return sum;
}

/// C = (t1 + t2)^2 / (E_f d^3) + 3.7 (1 / (t1 E1) + 1 / (t2 E2)). Some reviews print d for d^3, which does not have the
/// unit length / force.
Flexibility grumman(const FastenerGeometry& g) {
  const double grip = g.t[0] + g.t[1];
  const double shank = grip * grip / (g.E_f * g.d * g.d * g.d);
  return {3.7 / (g.t[0] * g.E[0]) + 3.7 / (g.t[1] * g.E[1]), shank, shank};
}

/// Bearing of the sheets and of the fastener, its shear 4 (t1 + t2) / (9 G_f A_f) and its bending
/// (t1^3 + 5 t1^2 t2 + 5 t1 t2^2 + t2^3) / (40 E_f I_f).
Flexibility tate_rosenfeld(const FastenerGeometry& g) {
  constexpr double pi = std::numbers::pi;
  const double t1 = g.t[0], t2 = g.t[1], d2 = g.d * g.d;
  const double shear = 4 * (t1 + t2) / (9 * g.E_f / (2 * (1 + g.nu_f)) * pi * d2 / 4);
  const double bending =
      (t1 * t1 * t1 + 5 * t1 * t1 * t2 + 5 * t1 * t2 * t2 + t2 * t2 * t2) / (40 * g.E_f * pi * d2 * d2 / 64);
  return {1 / (t1 * g.E[0]) + 1 / (t2 * g.E[1]), 1 / (t1 * g.E_f) + 1 / (t2 * g.E_f) + shear + bending,
          shear + bending};
}

/// C = [sum over the sheets of 2.845 / (E t) + c_f (0.5 / E_f + 1 / E_z) t / d^2] (d_head / d)^-0.34 (s / d)^-0.5
/// (p / d)^0.34 e^(0.3 r), with s the pitch in the row, p that of the rows, r their number.
///
/// c_f is 1 for aluminium rivets, 8.2 for countersunk ones, 13.1 for titanium Hi-Loks. Printed with 2845, 500 and 1000
/// for moduli in N/mm^2 and flexibilities in mm/kN.
Flexibility morris(const FastenerGeometry& g) {
  const double factor = std::pow(g.d_head / g.d, -0.34) * std::pow(g.pitch / g.d, -0.5) *
                        std::pow(g.row_pitch / g.d, 0.34) * std::exp(0.3 * g.rows);
  Flexibility sum{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double slender = g.c_f * g.t[i] / (g.d * g.d);
    sum.of_sheets += factor * 2.845 / (g.E[i] * g.t[i]) + factor * slender / g.E_z[i];
    sum.of_fastener += factor * slender * 0.5 / g.E_f;
  }
  return sum;
}

constexpr const char* huth_source = "H. Huth, LBF report FB-172, 1984, and ASTM STP 927, 1986";

/// All formulas of the program; a new one needs one function and one line here.
const std::vector<FlexibilityFormula> formulas{
    {"huth bolt", huth_bolt, true, {}, huth_source},
    {"huth rivet", huth_rivet, true, {}, huth_source},
    {"huth composite", huth_composite, true, {}, huth_source},
    {"swift", swift, false, {}, "T. Swift, Douglas Aircraft, ASTM STP 486, 1971"},
    {"boeing", boeing, false, {}, "Boeing, after L. Jarfall, Saab report KH R-3360, 1983"},
    {"grumman", grumman, false, {}, "Grumman Aerospace, after H. Huth, LBF report FB-172, 1984"},
    {"tate-rosenfeld",
     tate_rosenfeld,
     false,
     {"nu_f"},
     "M. B. Tate and S. J. Rosenfeld, NACA TN 1051, 1946, as later reviews have it for single shear"},
    {"morris",
     morris,
     false,
     {"E_z", "d_head", "pitch", "row_pitch", "rows", "c_f"},
     "G. Morris, 2004, after J. J. M. de Rijck, thesis TU Delft, 2005, known from one transcription of it: compare "
     "with another formula"},
};

const FlexibilityFormula& read_formula(const input::Value& law) {
  std::vector<std::string> names;
  for (const auto& formula : formulas) names.emplace_back(formula.name);
  return formulas[index_of(names, law.at("formula").choice(names))];
}

int read_shear(const input::Value& law, const FlexibilityFormula& formula) {
  const auto shear = law.at("shear");
  if (shear.choice({"single", "double"}) == "single") return 1;
  if (!formula.knows_double_shear)
    shear.not_allowed(fmt::format("\"single\", the only shear of the formula \"{}\"", formula.name));
  return 2;
}

std::array<double, 2> read_pair(const input::Value& law, const char* key) {
  const auto values = law.at(key).numbers(2, 2, input::positive);
  return {values[0], values[1]};
}

FastenerGeometry read_geometry(const input::Value& law, const FlexibilityFormula& formula, int n_shear) {
  constexpr double incompressible = 0.5;
  constexpr int max_rows = 100;
  const auto number = [&](const char* key) { return law.at(key).number(input::positive); };
  FastenerGeometry g{read_pair(law, "t"), read_pair(law, "E"), number("d"), number("E_f"), n_shear};
  const auto uses = [&](const char* key) {
    const bool used = index_of(formula.uses, std::string_view(key)) < count_of(formula.uses);
    if (const auto value = law.find(key); value && !used)
      value->fail("unknown key", fmt::format("no \"{}\", the formula \"{}\" does not use it", key, formula.name));
    return used;
  };
  if (uses("nu_f")) g.nu_f = law.at("nu_f").number({.low = 0, .high = incompressible});
  if (uses("E_z")) g.E_z = read_pair(law, "E_z");
  if (uses("d_head")) g.d_head = number("d_head");
  if (uses("pitch")) g.pitch = number("pitch");
  if (uses("row_pitch")) g.row_pitch = number("row_pitch");
  if (uses("rows")) g.rows = law.at("rows").integer(1, max_rows);
  if (uses("c_f")) g.c_f = number("c_f");
  return g;
}

}  // namespace

/// Reads {"type": "formula", "formula": "huth bolt", "mode": "total" or "fastener only", "shear": "single" or "double",
/// "t": [t1, t2], "E": [E1, E2], "d": d, "E_f": E_f}, and "nu_f" and the other numbers of FastenerGeometry where
/// the formula uses them.
///
/// In mode "total" the law has the whole flexibility, for sheets whose holes have nearly rigid springs; in mode
/// "fastener only" it lacks the bearing of the sheets, which the springs around the holes represent; in mode "shear and
/// bending" that of the shank too, which elastic pins in the holes have.
LawPointer read_formula_law(const input::Value& law) {
  law.only({"type", "formula", "mode", "shear", "t", "E", "d", "E_f", "nu_f", "E_z", "d_head", "pitch", "row_pitch",
            "rows", "c_f", "one_sided"});
  const auto& formula = read_formula(law);
  const std::string mode = law.at("mode").choice({"total", "fastener only", "shear and bending"});
  const int n_shear = read_shear(law, formula);
  const FastenerGeometry geometry = read_geometry(law, formula, n_shear);
  const auto [of_sheets, fastener, shank] = formula.flexibility(geometry);
  const double total = of_sheets + fastener;
  const bool whole = mode == "total", shank_alone = mode == "shear and bending";
  if (shank_alone && shank == 0)
    law.at("mode").fail(fmt::format("\"shear and bending\", which \"{}\" does not tell apart", formula.name),
                        "\"total\" or \"fastener only\", or the formula \"tate-rosenfeld\" or \"grumman\"");
  const double k = 1 / (n_shear * (whole ? total : shank_alone ? shank : fastener));
  return linear_law(k, Source{.text = fmt::format(
                                  "{} in {} shear, {}: {}; k = {:.6g}{}; flexibility{} {:.6g}, of which {:.6g} of the "
                                  "fastener",
                                  formula.name, n_shear == 1 ? "single" : "double", mode, formula.provenance, k,
                                  n_shear == 1 ? "" : " of each of the two shear planes",
                                  n_shear == 1 ? "" : " of both planes together", total, fastener),
                              .bearing_of_plate = whole,
                              .t = geometry.t,
                              .E = geometry.E,
                              .d = geometry.d,
                              .n_shear = n_shear});
}

}  // namespace fastjoint::stage3
