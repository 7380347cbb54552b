// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/laws/read_flexibility.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fastjoint::stage3 {
namespace {

const FlexibilityFormula& read_formula(const input::Value& law) {
  const auto formulas = flexibility_formulas();
  std::vector<std::string> names;
  names.reserve(formulas.size());
  for (const auto& formula : formulas) names.emplace_back(formula.name);
  const std::string name = law.at("formula").choice(names);
  return formulas[std::find(names.begin(), names.end(), name) - names.begin()];
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
            .rows = static_cast<double>(law.at("rows").integer(1, most_rows)),
            .c_f = law.at("c_f").number(input::positive)};
  for (const char* key : {"E_z", "d_head", "pitch", "row_pitch", "rows", "c_f"})
    if (const auto value = law.find(key))
      value->fail("unknown key", fmt::format("no \"{}\", the formula \"{}\" does not use it", key, formula.name));
  return {};
}

}  // namespace

Flexibility read_flexibility(const input::Value& law) {
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
  const double total = total_flexibility(terms), fastener = fastener_flexibility(terms);
  const bool whole = mode == "total";
  return {.stiffness = 1 / (n_shear * (whole ? total : fastener)),
          .mode = whole ? FlexibilityMode::total : FlexibilityMode::fastener_only,
          .geometry = geometry,
          .provenance =
              fmt::format("{} in {} shear, {}: {}; flexibility {:.6g}, of which {:.6g} of the fastener{}, in the "
                          "units of the joint",
                          formula.name, n_shear == 1 ? "single" : "double", mode, formula.provenance, total, fastener,
                          n_shear == 1 ? "" : ", of both planes together; the law is that of one plane")};
}

}  // namespace fastjoint::stage3
