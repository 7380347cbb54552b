// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "common/count.hpp"
#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {
namespace {

/// Numbers that only a formula with correlations for the row of fasteners asks for.
struct FastenerRows {
  std::array<double, 2> E_z;  ///< Young's modulus of the sheets through the thickness, force / length^2
  double d_head;              ///< diameter of the head, length
  double pitch, row_pitch;    ///< between fasteners of a row, between rows, length
  double rows;                ///< how many
  double c_f;                 ///< factor of the kind of fastener
};

/// Numbers of one fastener and the sheets that it joins, for published formulas, in any consistent units.
///
/// In double shear sheet 1 is the one in the middle and sheet 2 one of the two equal straps around it.
struct FastenerGeometry {
  std::array<double, 2> t;  ///< thickness, length
  std::array<double, 2> E;  ///< Young's modulus of the sheets along the load, force / length^2
  double d;                 ///< diameter of the shank, length
  double E_f;               ///< Young's modulus of the fastener, force / length^2
  double nu_f = 0;          ///< its Poisson's ratio, where the formula uses it
  int n_shear = 1;          ///< shear planes: 1, or 2 where the formula knows them
  FastenerRows rows{};      ///< where the formula uses them
};

/// One term of a formula: the bearing of a sheet, which the springs around a modelled hole have already, or what
/// the fastener itself gives.
struct FlexibilityTerm {
  bool of_the_fastener;
  double value;  ///< length / force
};

using Terms = std::vector<FlexibilityTerm>;

/// A published formula for the flexibility of a fastener: relative displacement of the sheets, beyond their own
/// stretch, per force of the whole fastener (in double shear: of both its planes together).
struct FlexibilityFormula {
  const char* name;
  Terms (*terms)(const FastenerGeometry&);
  bool knows_double_shear;
  bool uses_nu_f;
  const char* provenance;  ///< who, where, when
  bool uses_rows = false;
};

FlexibilityTerm of_plate(double value) { return {false, value}; }
FlexibilityTerm of_fastener(double value) { return {true, value}; }

/// C = ((t1 + t2) / (2 d))^a b / n (1 / (t1 E1) + 1 / (n t2 E2) + 1 / (2 t1 E_f) + 1 / (2 n t2 E_f)).
///
/// Equation (31) of LBF FB-172; its reprint in STP 927 is known for a slip, n for the 2 of the third term. Sheet 1 is
/// the middle one in double shear: it bears all the load, each strap half.
Terms huth(const FastenerGeometry& g, double a, double b) {
  const double n = g.n_shear;
  const double factor = std::pow((g.t[0] + g.t[1]) / (2 * g.d), a) * b / n;
  return {of_plate(factor / (g.t[0] * g.E[0])), of_plate(factor / (n * g.t[1] * g.E[1])),
          of_fastener(factor / (2 * g.t[0] * g.E_f)), of_fastener(factor / (2 * n * g.t[1] * g.E_f))};
}

Terms huth_bolt(const FastenerGeometry& g) { return huth(g, 2.0 / 3.0, 3.0); }
Terms huth_rivet(const FastenerGeometry& g) { return huth(g, 2.0 / 5.0, 2.2); }
Terms huth_composite(const FastenerGeometry& g) { return huth(g, 2.0 / 3.0, 4.2); }

/// C = 5 / (d E_f) + 0.8 (1 / (t1 E1) + 1 / (t2 E2)); all moduli were equal in the tests behind it.
Terms swift(const FastenerGeometry& g) {
  return {of_fastener(5 / (g.d * g.E_f)), of_plate(0.8 / (g.t[0] * g.E[0])), of_plate(0.8 / (g.t[1] * g.E[1]))};
}

/// C = sum over the sheets of 2^((t / d)^0.85) / t (1 / E + 3 / (8 E_f)).
Terms boeing(const FastenerGeometry& g) {
  Terms terms;
  for (std::size_t i = 0; i < 2; ++i) {
    const double factor = std::exp2(std::pow(g.t[i] / g.d, 0.85)) / g.t[i];
    terms.push_back(of_plate(factor / g.E[i]));
    terms.push_back(of_fastener(factor * 3 / (8 * g.E_f)));
  }
  return terms;
}

/// C = (t1 + t2)^2 / (E_f d^3) + 3.7 (1 / (t1 E1) + 1 / (t2 E2)). Some reviews print d for d^3, which is no
/// length / force.
Terms grumman(const FastenerGeometry& g) {
  const double grip = g.t[0] + g.t[1];
  return {of_fastener(grip * grip / (g.E_f * g.d * g.d * g.d)), of_plate(3.7 / (g.t[0] * g.E[0])),
          of_plate(3.7 / (g.t[1] * g.E[1]))};
}

/// Bearing of the sheets and of the fastener, its shear 4 (t1 + t2) / (9 G_f A_f) and its bending
/// (t1^3 + 5 t1^2 t2 + 5 t1 t2^2 + t2^3) / (40 E_f I_f).
Terms tate_rosenfeld(const FastenerGeometry& g) {
  constexpr double pi = std::numbers::pi;
  const double t1 = g.t[0], t2 = g.t[1], d2 = g.d * g.d;
  const double shear = 4 * (t1 + t2) / (9 * g.E_f / (2 * (1 + g.nu_f)) * pi * d2 / 4);
  const double bending =
      (t1 * t1 * t1 + 5 * t1 * t1 * t2 + 5 * t1 * t2 * t2 + t2 * t2 * t2) / (40 * g.E_f * pi * d2 * d2 / 64);
  return {of_plate(1 / (t1 * g.E[0])),   of_plate(1 / (t2 * g.E[1])), of_fastener(1 / (t1 * g.E_f)),
          of_fastener(1 / (t2 * g.E_f)), of_fastener(shear),          of_fastener(bending)};
}

/// C = [sum over the sheets of 2.845 / (E t) + c_f (0.5 / E_f + 1 / E_z) t / d^2] (d_head / d)^-0.34 (s / d)^-0.5
/// (p / d)^0.34 e^(0.3 r), with s the pitch in the row, p that of the rows, r their number.
///
/// c_f is 1 for aluminium rivets, 8.2 for countersunk ones, 13.1 for titanium Hi-Loks. Printed with 2845, 500 and 1000
/// for moduli in N/mm^2 and flexibilities in mm/kN.
Terms morris(const FastenerGeometry& g) {
  const FastenerRows& more = g.rows;
  const double factor = std::pow(more.d_head / g.d, -0.34) * std::pow(more.pitch / g.d, -0.5) *
                        std::pow(more.row_pitch / g.d, 0.34) * std::exp(0.3 * more.rows);
  Terms terms;
  for (std::size_t i = 0; i < 2; ++i) {
    const double slender = more.c_f * g.t[i] / (g.d * g.d);
    terms.push_back(of_plate(factor * 2.845 / (g.E[i] * g.t[i])));
    terms.push_back(of_plate(factor * slender / more.E_z[i]));
    terms.push_back(of_fastener(factor * slender * 0.5 / g.E_f));
  }
  return terms;
}

constexpr const char* huth_source = "H. Huth, LBF report FB-172, 1984, and ASTM STP 927, 1986";

/// All formulas that the program knows; a new one is one function and one line here.
constexpr std::array formulas{
    FlexibilityFormula{"huth bolt", huth_bolt, true, false, huth_source},
    FlexibilityFormula{"huth rivet", huth_rivet, true, false, huth_source},
    FlexibilityFormula{"huth composite", huth_composite, true, false, huth_source},
    FlexibilityFormula{"swift", swift, false, false, "T. Swift, Douglas Aircraft, ASTM STP 486, 1971"},
    FlexibilityFormula{"boeing", boeing, false, false, "Boeing, after L. Jarfall, Saab report KH R-3360, 1983"},
    FlexibilityFormula{"grumman", grumman, false, false, "Grumman Aerospace, after H. Huth, LBF report FB-172, 1984"},
    FlexibilityFormula{"tate-rosenfeld", tate_rosenfeld, false, true,
                       "M. B. Tate and S. J. Rosenfeld, NACA TN 1051, 1946, as later reviews have it for single shear"},
    FlexibilityFormula{
        "morris", morris, false, false,
        "G. Morris, 2004, after J. J. M. de Rijck, thesis TU Delft, 2005, known from one transcription of "
        "it: compare with another formula",
        true},
};

/// Sum of the terms, length / force.
double sum(const Terms& terms, bool of_the_fastener_alone) {
  double flexibility = 0;
  for (const auto& term : terms)
    if (term.of_the_fastener || !of_the_fastener_alone) flexibility += term.value;
  return flexibility;
}

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

double read_nu(const input::Value& law, const FlexibilityFormula& formula) {
  constexpr double incompressible = 0.5;
  const input::Range poisson{.low = 0, .high = incompressible};
  if (formula.uses_nu_f) return law.at("nu_f").number(poisson);
  if (const auto nu = law.find("nu_f"))
    nu->fail("unknown key", fmt::format("no \"nu_f\", the formula \"{}\" does not use it", formula.name));
  return 0;
}

std::array<double, 2> read_pair(const input::Value& law, const char* key) {
  const auto values = law.at(key).numbers(2, 2, input::positive);
  return {values[0], values[1]};
}

FastenerRows read_rows(const input::Value& law, const FlexibilityFormula& formula) {
  constexpr int most_rows = 100;
  if (formula.uses_rows)
    return {.E_z = read_pair(law, "E_z"),
            .d_head = law.at("d_head").number(input::positive),
            .pitch = law.at("pitch").number(input::positive),
            .row_pitch = law.at("row_pitch").number(input::positive),
            .rows = double(law.at("rows").integer(1, most_rows)),
            .c_f = law.at("c_f").number(input::positive)};
  for (const char* key : {"E_z", "d_head", "pitch", "row_pitch", "rows", "c_f"})
    if (const auto value = law.find(key))
      value->fail("unknown key", fmt::format("no \"{}\", the formula \"{}\" does not use it", key, formula.name));
  return {};
}

}  // namespace

/// Reads {"type": "formula", "formula": "huth bolt", "mode": "total" or "fastener only", "shear": "single" or "double",
/// "t": [t1, t2], "E": [E1, E2], "d": d, "E_f": E_f}, and "nu_f" and FastenerRows where the formula uses them.
///
/// In mode "total" the law takes all terms, for sheets whose holes have springs that hardly give; in "fastener only"
/// those that the bearing of the sheets does not make, because the springs around the holes have it.
LawPointer read_formula_law(const input::Value& law) {
  law.only({"type", "formula", "mode", "shear", "t", "E", "d", "E_f", "nu_f", "E_z", "d_head", "pitch", "row_pitch",
            "rows", "c_f", "one_sided"});
  const auto& formula = read_formula(law);
  const std::string mode = law.at("mode").choice({"total", "fastener only"});
  const int n_shear = read_shear(law, formula);
  const FastenerGeometry geometry{.t = read_pair(law, "t"),
                                  .E = read_pair(law, "E"),
                                  .d = law.at("d").number(input::positive),
                                  .E_f = law.at("E_f").number(input::positive),
                                  .nu_f = read_nu(law, formula),
                                  .n_shear = n_shear,
                                  .rows = read_rows(law, formula)};
  const auto terms = formula.terms(geometry);
  const double total = sum(terms, false), fastener = sum(terms, true);
  const bool whole = mode == "total";
  return linear_law(
      1 / (n_shear * (whole ? total : fastener)),
      Source{.text = fmt::format(
                 "{} in {} shear, {}: {}; flexibility {:.6g}, of which {:.6g} of the fastener{}, in the units of the "
                 "joint",
                 formula.name, n_shear == 1 ? "single" : "double", mode, formula.provenance, total, fastener,
                 n_shear == 1 ? "" : ", of both planes together; the law is that of one plane"),
             .bearing_of_plate = whole,
             .t = geometry.t,
             .E = geometry.E,
             .d = geometry.d});
}

}  // namespace fastjoint::stage3
