// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "common/input/value.hpp"

namespace fastjoint::stage3 {

/// Distribution of a number, by its quantiles.
struct Distribution {
  std::function<double(double)> at{};  ///< quantile of a probability in (0, 1)
  double largest = 0;                  ///< the largest number, or one that is exceeded with negligible probability
};

/// Reads {"type": "uniform" | "normal" | "lognormal" | "triangular" | "discrete", ...}; normal and lognormal ones may
/// be truncated by "from" and "to". Throws InputError.
[[nodiscard]] Distribution read_distribution(const input::Value& value);

/// Values in their order. @param weights Proportional to their probabilities; empty: equal ones.
[[nodiscard]] Distribution discrete(std::vector<double> values, std::vector<double> weights = {});

}  // namespace fastjoint::stage3
