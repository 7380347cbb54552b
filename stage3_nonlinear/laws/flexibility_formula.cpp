// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/laws/flexibility_formula.hpp"

#include <cmath>
#include <numbers>

namespace fastjoint::stage3 {
namespace {

using Terms = std::vector<FlexibilityTerm>;

FlexibilityTerm of_sheet(double value) { return {false, value}; }
FlexibilityTerm of_fastener(double value) { return {true, value}; }

/// C = ((t1 + t2) / (2 d))^a b / n (1 / (t1 E1) + 1 / (n t2 E2) + 1 / (2 t1 E_f) + 1 / (2 n t2 E_f)).
///
/// Equation (31) of LBF FB-172; its reprint in STP 927 is known for a slip, n for the 2 of the third term. Sheet 1 is
/// the middle one in double shear: it bears all the load, each strap half.
Terms huth(const FastenerGeometry& g, double a, double b) {
  const double n = g.n_shear;
  const double factor = std::pow((g.t[0] + g.t[1]) / (2 * g.d), a) * b / n;
  return {of_sheet(factor / (g.t[0] * g.E[0])), of_sheet(factor / (n * g.t[1] * g.E[1])),
          of_fastener(factor / (2 * g.t[0] * g.E_f)), of_fastener(factor / (2 * n * g.t[1] * g.E_f))};
}

Terms huth_bolt(const FastenerGeometry& g) { return huth(g, 2.0 / 3.0, 3.0); }
Terms huth_rivet(const FastenerGeometry& g) { return huth(g, 2.0 / 5.0, 2.2); }
Terms huth_composite(const FastenerGeometry& g) { return huth(g, 2.0 / 3.0, 4.2); }

/// C = 5 / (d E_f) + 0.8 (1 / (t1 E1) + 1 / (t2 E2)); all moduli were equal in the tests behind it.
Terms swift(const FastenerGeometry& g) {
  return {of_fastener(5 / (g.d * g.E_f)), of_sheet(0.8 / (g.t[0] * g.E[0])), of_sheet(0.8 / (g.t[1] * g.E[1]))};
}

/// C = sum over the sheets of 2^((t / d)^0.85) / t (1 / E + 3 / (8 E_f)).
Terms boeing(const FastenerGeometry& g) {
  Terms terms;
  for (std::size_t i = 0; i < 2; ++i) {
    const double factor = std::exp2(std::pow(g.t[i] / g.d, 0.85)) / g.t[i];
    terms.push_back(of_sheet(factor / g.E[i]));
    terms.push_back(of_fastener(factor * 3 / (8 * g.E_f)));
  }
  return terms;
}

/// C = (t1 + t2)^2 / (E_f d^3) + 3.7 (1 / (t1 E1) + 1 / (t2 E2)). Some reviews print d for d^3, which is no
/// length / force.
Terms grumman(const FastenerGeometry& g) {
  const double grip = g.t[0] + g.t[1];
  return {of_fastener(grip * grip / (g.E_f * g.d * g.d * g.d)), of_sheet(3.7 / (g.t[0] * g.E[0])),
          of_sheet(3.7 / (g.t[1] * g.E[1]))};
}

/// Bearing of the sheets and of the fastener, its shear 4 (t1 + t2) / (9 G_f A_f) and its bending
/// (t1^3 + 5 t1^2 t2 + 5 t1 t2^2 + t2^3) / (40 E_f I_f).
Terms tate_rosenfeld(const FastenerGeometry& g) {
  constexpr double pi = std::numbers::pi;
  const double t1 = g.t[0], t2 = g.t[1], d2 = g.d * g.d;
  const double shear = 4 * (t1 + t2) / (9 * g.E_f / (2 * (1 + g.nu_f)) * pi * d2 / 4);
  const double bending =
      (t1 * t1 * t1 + 5 * t1 * t1 * t2 + 5 * t1 * t2 * t2 + t2 * t2 * t2) / (40 * g.E_f * pi * d2 * d2 / 64);
  return {of_sheet(1 / (t1 * g.E[0])),   of_sheet(1 / (t2 * g.E[1])), of_fastener(1 / (t1 * g.E_f)),
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
    terms.push_back(of_sheet(factor * 2.845 / (g.E[i] * g.t[i])));
    terms.push_back(of_sheet(factor * slender / more.E_z[i]));
    terms.push_back(of_fastener(factor * slender * 0.5 / g.E_f));
  }
  return terms;
}

constexpr const char* huth_source = "H. Huth, LBF report FB-172, 1984, and ASTM STP 927, 1986";

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

double sum(const Terms& terms, bool all) {
  double flexibility = 0;
  for (const auto& term : terms)
    if (all || term.of_the_fastener) flexibility += term.value;
  return flexibility;
}

}  // namespace

std::span<const FlexibilityFormula> flexibility_formulas() { return formulas; }

double total_flexibility(const Terms& terms) { return sum(terms, true); }
double fastener_flexibility(const Terms& terms) { return sum(terms, false); }

}  // namespace fastjoint::stage3
