// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/path/contact_event.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Eigen::VectorXi;

std::vector<Mark> marks_of(const Contact& contact) {
  constexpr double equal = 1e-9;
  const Law& law = *contact.law;
  const double k = contact.stiffness;
  const double gap = law.gap(contact.clearance);
  std::vector<Mark> result;
  const auto kinks = law.kinks(k, contact.clearance);
  if (!kinks) {
    if (gap > 0 || contact.one_sided) result.push_back({k * gap, Corner::contact});
    return result;
  }
  if (gap == 0 && contact.one_sided) result.push_back({0, Corner::contact});
  for (const double c : *kinks) {
    const double delta = law.at(c, k, contact.clearance).delta;
    const Corner corner = std::abs(delta - gap) <= equal * gap ? Corner::contact
                          : delta < gap                        ? Corner::slip
                                                               : Corner::yield;
    result.push_back({c, corner});
  }
  return result;
}

/// Of one fastener and of several, away from the origin and back.
struct Words {
  Corner corner;
  std::array<const char*, 2> onward, back;
};

constexpr std::array words{Words{Corner::slip, {"slips", "slip"}, {"sticks again", "stick again"}},
                           Words{Corner::contact, {"closes", "close"}, {"opens", "open"}},
                           Words{Corner::yield, {"yields", "yield"}, {"is elastic again", "are elastic again"}}};

}  // namespace

ContactMarks::ContactMarks(const std::vector<Contact>& contacts) {
  for (const auto& contact : contacts) {
    marks_.push_back(marks_of(contact));
    one_sided_.push_back(contact.one_sided);
  }
}

double ContactMarks::nearness(const VectorXd& c, double at) {
  constexpr double of_mark = 1e-9, of_largest = 1e-10;
  return of_mark * at + of_largest * c.cwiseAbs().maxCoeff();
}

VectorXd ContactMarks::positions(const VectorXd& c) const { return amounts(c, c.size() / marks_.size()); }

VectorXi ContactMarks::stages(const VectorXd& c) const {
  const VectorXd x = positions(c);
  VectorXi result(x.size());
  for (Index j = 0; j < x.size(); ++j) {
    const bool mirrored = x[j] < 0 && !one_sided_[j];
    const double position = mirrored ? -x[j] : x[j];
    const auto& marks = of(j);
    const auto reached = static_cast<int>(std::count_if(
        marks.begin(), marks.end(), [&](const Mark& mark) { return position >= mark.at - nearness(c, mark.at); }));
    result[j] = mirrored ? -reached : reached;
  }
  return result;
}

std::vector<ContactEvent> ContactMarks::between(const VectorXi& before, const VectorXi& after) const {
  std::vector<ContactEvent> result;
  for (Index j = 0; j < before.size(); ++j) {
    const auto& marks = of(j);
    const int was = std::abs(before[j]), is = std::abs(after[j]);
    const int common = before[j] * after[j] < 0 ? 0 : std::min(was, is);
    for (int i = was; i-- > common;) result.push_back({j, marks[i].corner, true});
    for (int i = common; i < is; ++i) result.push_back({j, marks[i].corner, false});
  }
  return result;
}

std::vector<ContactEvent> ContactMarks::at(const VectorXd& before, const VectorXd& c) const {
  std::vector<ContactEvent> result;
  if (c.isZero(0)) return result;
  const VectorXd x = positions(c), was = positions(before);
  for (Index j = 0; j < x.size(); ++j) {
    const bool mirrored = x[j] < 0 && !one_sided_[j];
    const double sign = mirrored ? -1 : 1;
    for (const Mark& mark : of(j)) {
      const double near = nearness(c, mark.at);
      if (std::abs(sign * x[j] - mark.at) > near || std::abs(sign * was[j] - mark.at) <= near) continue;
      result.push_back({j, mark.corner, sign * was[j] > mark.at});
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
        if (event.corner == each.corner && event.back == back)
          names.push_back(joint.short_name(joint.planes[event.plane]));
      if (names.empty()) continue;
      const auto& verb = back ? each.back : each.onward;
      parts.push_back(fmt::format("{} {}", fmt::join(names, ", "), verb[names.size() == 1 ? 0 : 1]));
    }
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace fastjoint::stage3
