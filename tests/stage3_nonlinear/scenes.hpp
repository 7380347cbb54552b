// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>

#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::test {

/// Laws as the input gives them; `text` is their JSON.
[[nodiscard]] std::shared_ptr<const stage3::Law> law_of(const std::string& text);
[[nodiscard]] std::shared_ptr<const stage3::Law> linear_law(double k);
[[nodiscard]] std::shared_ptr<const stage3::Law> power_law(double A, double n, double delta0 = 0);
/// Without memory.
[[nodiscard]] std::shared_ptr<const stage3::Law> bilinear_law(double k, double F_yield, double k_yield);
[[nodiscard]] std::shared_ptr<const stage3::Law> cubic_law(const std::array<double, 3>& delta,
                                                           const std::array<double, 3>& F);

/// A JOINT.json with these members of its object. What they do not give is: plates "a" and "b" in a.h5 and b.h5, law
/// "lin" (k = 1000), fasteners "f1", "f2" through holes 1 and 2, force 100 on "a:P", one increment.
[[nodiscard]] std::string joint_text(const std::map<std::string, std::string>& members = {});

}  // namespace fastjoint::test
