// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/stage3_nonlinear/scenes.hpp"

#include <fmt/ranges.h>

namespace fastjoint::test {

std::shared_ptr<const stage3::Law> law_of(const std::string& text) {
  return stage3::read_law(input::Value(input::parse("joint.json", text)));
}

std::shared_ptr<const stage3::Law> linear_law(double k) {
  return law_of(fmt::format(R"({{"type": "linear", "k": {}}})", k));
}

std::shared_ptr<const stage3::Law> power_law(double A, double n, double delta0) {
  return law_of(fmt::format(R"({{"type": "power", "A": {}, "n": {}, "delta0": {}}})", A, n, delta0));
}

std::shared_ptr<const stage3::Law> bilinear_law(double k, double F_yield, double k_yield) {
  return law_of(fmt::format(R"({{"type": "bilinear", "k": {}, "F_yield": {}, "k_yield": {}, "reversible": true}})", k,
                            F_yield, k_yield));
}

std::shared_ptr<const stage3::Law> cubic_law(const std::array<double, 3>& delta, const std::array<double, 3>& F) {
  return law_of(fmt::format(R"({{"type": "cubic", "delta": {}, "F": {}}})", delta, F));
}

std::string joint_text(const std::map<std::string, std::string>& members) {
  std::map<std::string, std::string> all{{"format", R"("joint")"},
                                         {"version", "1"},
                                         {"plates", R"({"a": "a.h5", "b": "b.h5"})"},
                                         {"laws", R"({"lin": {"type": "linear", "k": 1000}})"},
                                         {"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin"},
                       {"id": "f2", "between": ["a:2", "b:2"], "law": "lin"}])"},
                                         {"loads", R"([{"external": "a:P", "force": 100}])"},
                                         {"increments", "1"}};
  for (const auto& [key, value] : members) all[key] = value;
  std::string text = "{";
  for (const auto& [key, value] : all)
    if (!value.empty()) text += (text.size() > 1 ? ",\n\"" : "\n\"") + key + "\": " + value;
  return text + "\n}\n";
}

}  // namespace fastjoint::test
