// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "common/infinite.hpp"
#include "common/input/value.hpp"

namespace fastjoint::stage3 {

/// Distribution of a number, by its quantiles.
class Distribution {
 public:
  virtual ~Distribution() = default;
  /// Quantile of a probability in (0, 1).
  [[nodiscard]] virtual double at(double probability) const = 0;
  /// The largest number, or one that is exceeded with negligible probability.
  [[nodiscard]] virtual double largest() const { return at(1 - 1e-15); }
};

/// Reads {"type": "uniform" | "normal" | "lognormal" | "triangular" | "discrete", ...}; normal and lognormal ones may
/// be truncated by "from" and "to". Throws InputError.
[[nodiscard]] std::shared_ptr<const Distribution> read_distribution(const input::Value& value);

/// Values of equal probability, in their order.
[[nodiscard]] std::shared_ptr<const Distribution> discrete(std::vector<double> values);

}  // namespace fastjoint::stage3
