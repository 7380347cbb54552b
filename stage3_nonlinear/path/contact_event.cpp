// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/path/load_path.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace fastjoint::stage3 {
namespace {

using Eigen::VectorXi;

std::vector<Corner> corners_of(const Contact& contact) {
  constexpr double equal = 1e-9;
  const Law& law = *contact.law;
  const double k = contact.stiffness;
  const double gap = law.gap(contact.clearance);
  std::vector<Corner> result;
  const auto corners = law.corners(k, contact.clearance);
  // Among the corners of a law that is linear between them is that of its gap.
  if (corners ? gap == 0 && contact.one_sided : gap > 0 || contact.one_sided)
    result.push_back({k * gap, CornerKind::contact});
  for (const double c : corners.value_or(std::vector<double>{})) {
    const double delta = law.at(c, k, contact.clearance).delta;
    const CornerKind kind = std::abs(delta - gap) <= equal * gap ? CornerKind::contact
                            : delta < gap                        ? CornerKind::slip
                                                                 : CornerKind::yield;
    result.push_back({c, kind});
  }
  return result;
}

/// Verbs for one fastener and for several, away from the origin and back.
struct Words {
  CornerKind kind;
  std::array<const char*, 2> onward, back;
};

constexpr std::array words{Words{CornerKind::slip, {"slips", "slip"}, {"sticks again", "stick again"}},
                           Words{CornerKind::contact, {"closes", "close"}, {"opens", "open"}},
                           Words{CornerKind::yield, {"yields", "yield"}, {"is elastic again", "are elastic again"}}};

}  // namespace

ContactCorners::ContactCorners(const std::vector<Contact>& contacts) {
  for (const auto& contact : contacts) {
    corners_.push_back(corners_of(contact));
    one_sided_.push_back(contact.one_sided);
  }
}

double ContactCorners::nearness(const VectorXd& c, double at) {
  constexpr double of_corner = 1e-9, of_largest = 1e-10;
  return of_corner * at + of_largest * c.cwiseAbs().maxCoeff();
}

VectorXi ContactCorners::passed(const VectorXd& c) const {
  const VectorXd x = amounts(c, c.size() / corners_.size());
  VectorXi result(x.size());
  for (Index j = 0; j < std::ssize(x); ++j) {
    const bool mirrored = x[j] < 0 && !one_sided_[j];
    const double position = mirrored ? -x[j] : x[j];
    const auto& own = of(j);
    const int reached = int(std::count_if(
        own.begin(), own.end(), [&](const Corner& corner) { return position >= corner.at - nearness(c, corner.at); }));
    result[j] = mirrored ? -reached : reached;
  }
  return result;
}

std::vector<ContactEvent> ContactCorners::between(const VectorXi& before, const VectorXi& after) const {
  std::vector<ContactEvent> result;
  for (Index j = 0; j < std::ssize(before); ++j) {
    const auto& own = of(j);
    const int was = std::abs(before[j]), is = std::abs(after[j]);
    const int common = before[j] * after[j] < 0 ? 0 : std::min(was, is);
    for (int i = was; i-- > common;) result.push_back({j, own[i].kind, true});
    for (int i = common; i < is; ++i) result.push_back({j, own[i].kind, false});
  }
  return result;
}

std::vector<ContactEvent> ContactCorners::at(const VectorXd& before, const VectorXd& c) const {
  std::vector<ContactEvent> result;
  if (c.isZero(0)) return result;
  const Index n_directions = c.size() / corners_.size();
  const VectorXd x = amounts(c, n_directions), was = amounts(before, n_directions);
  for (Index j = 0; j < std::ssize(x); ++j) {
    const bool mirrored = x[j] < 0 && !one_sided_[j];
    const double sign = mirrored ? -1 : 1;
    for (const Corner& corner : of(j)) {
      const double near = nearness(c, corner.at);
      if (std::abs(sign * x[j] - corner.at) > near || std::abs(sign * was[j] - corner.at) <= near) continue;
      result.push_back({j, corner.kind, sign * was[j] > corner.at});
    }
  }
  return result;
}

std::string event_text(const JointModel& joint, const std::vector<ContactEvent>& events) {
  std::vector<std::string> parts;
  for (const bool back : {false, true})
    for (const Words& each : words) {
      std::vector<std::string> names;
      for (const auto& event : events)
        if (event.kind == each.kind && event.back == back) names.push_back(joint.short_name(joint.planes[event.plane]));
      if (names.empty()) continue;
      const auto& verb = back ? each.back : each.onward;
      parts.push_back(fmt::format("{} {}", fmt::join(names, ", "), verb[names.size() == 1 ? 0 : 1]));
    }
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace fastjoint::stage3
