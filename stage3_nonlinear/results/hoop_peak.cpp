// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/hoop_peak.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "common/rim/angles.hpp"
#include "stage3_nonlinear/results/near_stress.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;

/// Half width of the excluded range around a jump of friction, degrees: the point itself and its neighbours.
constexpr double excluded = 7.5;

double turn(double angle) { return angle - 360 * std::round(angle / 360); }

/// Hoop stress on a circle: at equidistant points, and as a function; angles in radians.
struct Curve {
  VectorXd angles, values;
  std::function<double(double)> at;
  std::shared_ptr<const HoopStress> on_rim;
};

class PeakSearch {
 public:
  PeakSearch(const LoadedRim& rim, const std::vector<double>& jumps, double distance)
      : rim_(rim), jumps_(jumps), distance_(distance) {}

  [[nodiscard]] std::optional<HoopPeak> find() const {
    const auto tractions = rim_.traction_waves(rim_.degrees[0].tractions);
    const Curve hoop = curve(0, rim_.rim.waves, tractions);
    const auto peak = top(hoop, rim_.kinks);
    if (!peak) return std::nullopt;
    const Index n = hoop.angles.size(),
                nearest = static_cast<Index>(std::floor(peak->angle / rim::full_turn * double(n))) % n;
    VectorXd at_points =
        VectorXd::NullaryExpr(n, [&](Index i) { return is_allowed(hoop.angles[i]) ? hoop.values[i] : std::nan(""); });
    double value = peak->value, bar = error(hoop, *peak, tractions);
    const bool is_root = rim_.has_root_at_end && distance_ == 0;
    if (rim_.in_contact && (is_root || std::isfinite(bar))) {
      constexpr double of_known_rate = 0.25;  // an extrapolated peak is right to a tenth of the change, rarely a fifth
      const double further = by_further_waves(*peak);
      if (is_root) value += further;
      bar += (is_root ? of_known_rate : 1) * std::abs(further);
    }
    at_points[(nearest + n) % n] = value;
    return HoopPeak{value, turn(peak->angle / rim::degree), bar, at_points};
  }

 private:
  struct Peak {
    double value, angle;  ///< radians
  };

  /// Hoop stress from the displacements of one degree up to an order.
  [[nodiscard]] Curve curve(Index degree, const rim::Harmonics& shape,
                            const std::shared_ptr<const TractionWaves>& tractions) const {
    const auto on_rim = std::make_shared<const HoopStress>(rim_.hoop(degree, shape, tractions));
    if (distance_ == 0)
      return {on_rim->angles(), on_rim->values(), [on_rim](double angle) { return on_rim->at(angle); }, on_rim};
    const NearStress near(*on_rim, distance_);
    const auto hoop = [near](double angle) { return near.at(angle)[1]; };
    return {on_rim->angles(), on_rim->angles().unaryExpr(hoop), hoop, on_rim};
  }

  /// Largest of all values at the points and at kinks of the tractions, then the largest within a step of it.
  [[nodiscard]] std::optional<Peak> top(const Curve& hoop, const std::vector<double>& kinks) const {
    const auto &angle = hoop.angles, &value = hoop.values;
    const Index n = angle.size();
    std::optional<Index> best;
    for (Index i = 0; i < n; ++i)
      if (is_allowed(angle[i]) && (!best || value[i] > value[*best])) best = i;
    if (!best) return std::nullopt;
    // The last of equal peaks is taken, such as those on either side of a line of symmetry, so that rounding on another
    // machine does not choose.
    constexpr double equal = 1e-9;
    constexpr Index apart = 3;
    for (Index i = n - 1; i > *best + apart; --i)
      if (is_allowed(angle[i]) && value[i] >= (1 - equal) * value[*best] && *best + n - i > apart &&
          value[i] >= value[i - 1] && value[i] >= value[(i + 1) % n]) {
        best = i;
        break;
      }
    Peak peak{value[*best], angle[*best]};
    for (const double kink : kinks)
      if (is_allowed(kink))
        if (const double there = hoop.at(kink); there > peak.value) peak = {there, kink};
    return top_near(hoop, kinks, peak, angle[1] - angle[0]);
  }

  /// Largest value within a step of an angle by golden sections of each piece between kinks, so that it does not depend
  /// on where the points lie.
  [[nodiscard]] Peak top_near(const Curve& hoop, const std::vector<double>& kinks, Peak peak, double step) const {
    std::vector<double> ends{peak.angle - step, peak.angle, peak.angle + step};
    for (const double kink : kinks)
      if (const double past = rim::wrapped(kink - peak.angle); std::abs(past) < step) ends.push_back(peak.angle + past);
    std::ranges::sort(ends);
    constexpr int sections = 16;  // a step / 2000 is left, of a value that is level there
    constexpr double golden = std::numbers::phi - 1;
    constexpr double never = 1e100;  // where a point is excluded, and the more so the further away
    const auto at = [&](double angle) {
      return is_allowed(angle) ? hoop.at(angle) : -never * std::abs(angle - peak.angle);
    };
    for (std::size_t piece = 1; piece < ends.size(); ++piece) {
      double from = ends[piece - 1], to = ends[piece];
      Peak low{0, to - golden * (to - from)}, high{0, from + golden * (to - from)};
      low.value = at(low.angle), high.value = at(high.angle);
      for (int section = 0; section < sections; ++section)
        if (low.value > high.value) {
          to = std::exchange(high, low).angle;
          low.angle = to - golden * (to - from), low.value = at(low.angle);
        } else {
          from = std::exchange(low, high).angle;
          high.angle = from + golden * (to - from), high.value = at(high.angle);
        }
      for (const Peak& each : {low, high})
        if (each.value > peak.value) peak = each;
    }
    return peak;
  }

  /// True on the modelled part of the rim, away from jumps of friction.
  [[nodiscard]] bool is_allowed(double angle) const {
    const auto& waves = rim_.rim.waves;
    constexpr double rounding = 1e-9;
    if (!waves.is_whole() && rim::wrapped(angle, waves.start - rounding) > waves.start + waves.sweep + rounding)
      return false;
    return std::ranges::none_of(jumps_,
                                [&](double jump) { return std::abs(turn(angle / rim::degree - jump)) <= excluded; });
  }

  /// Extrapolated change of a peak in contact by all further waves, from that by fewer waves.
  [[nodiscard]] double by_further_waves(const Peak& peak) const {
    const auto other = top(curve(0, rim_.rim.waves, rim_.traction_waves(rim_.by_fewer)), rim_.kinks_by_fewer);
    return other ? rim_.beyond * (peak.value - other->value) : 0;
  }

  /// Sum of twice the change from the degree below, and the extrapolated change by all further orders, from that by the
  /// last two or four pairs of orders (docs/theory.md, section 11.4). Infinite if it is not known.
  [[nodiscard]] double error(const Curve& hoop, const Peak& peak,
                             const std::shared_ptr<const TractionWaves>& tractions) const {
    const rim::Harmonics& all = rim_.rim.waves;
    // One wave tells nothing about further ones.
    if (rim_.degrees.size() < 2 || all.highest < 2 || !std::isfinite(rim_.beyond))
      return std::numeric_limits<double>::infinity();
    const Curve lower = curve(1, all, rim_.in_contact ? tractions : rim_.traction_waves(rim_.degrees[1].tractions));
    const double by_degree = largest(lower.values - hoop.values, hoop, peak.angle);
    // Changes by successive pairs of orders alternate around shapes of four sides: they fall over two pairs at a time.
    const int n = all.highest < 8 ? 1 : 2;  // pairs
    std::array<double, 2> changed{};        // by the last n pairs, and by those before
    for (int pair = 0, end = all.highest; pair < 2 * n; ++pair) {
      const int first = std::max(end - 2, 1);
      changed[pair / n] += largest(change_by_orders(hoop, tractions, first, end), hoop, peak.angle);
      end = first;
    }
    const double fastest = std::pow(0.1, n), slowest = std::pow(0.8, n);
    const double fall = std::clamp(changed[1] > 0 ? changed[0] / changed[1] : slowest, fastest, slowest);
    return 2 * by_degree + changed[0] * fall / (1 - fall);
  }

  /// Change of the hoop stress at the points if orders first..end-1 followed from the tractions.
  [[nodiscard]] VectorXd change_by_orders(const Curve& hoop, const std::shared_ptr<const TractionWaves>& tractions,
                                          int first, int end) const {
    if (distance_ == 0) return hoop.on_rim->change_by_tractions(first, end);
    rim::Harmonics shape = rim_.rim.waves;
    const auto up_to = [&](int order) {
      shape.highest = order;
      return curve(0, shape, tractions).values;
    };
    return up_to(first) - up_to(end);
  }

  /// Largest magnitude at the points within 45 degrees of an angle.
  [[nodiscard]] double largest(const VectorXd& all, const Curve& hoop, double angle) const {
    constexpr double around = rim::full_turn / 8;
    double found = 0;
    for (Index i = 0; i < all.size(); ++i)
      if (is_allowed(hoop.angles[i]) && std::abs(rim::wrapped(hoop.angles[i] - angle)) <= around)
        found = std::max(found, std::abs(all[i]));
    return found;
  }

  const LoadedRim& rim_;
  const std::vector<double>& jumps_;
  double distance_;
};

}  // namespace

std::optional<HoopPeak> hoop_peak(const LoadedRim& rim, const std::vector<double>& jumps, double distance) {
  return PeakSearch(rim, jumps, distance).find();
}

}  // namespace fastjoint::stage3
