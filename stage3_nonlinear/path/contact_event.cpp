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

/// Verbs for one fastener and for several, away from the origin and back.
struct Words {
  CornerKind kind;
  std::array<const char*, 2> onward, back;
};

constexpr std::array words{
    Words{CornerKind::slip, {"slips", "slip"}, {"sticks again", "stick again"}},
    Words{CornerKind::contact, {"closes", "close"}, {"opens", "open"}},
    Words{CornerKind::yield, {"yields", "yield"}, {"is elastic again", "are elastic again"}},
    Words{CornerKind::touch, {"touches", "touch"}, {"opens", "open"}},
    Words{
        CornerKind::part, {"loses full contact", "lose full contact"}, {"is in full contact", "are in full contact"}}};

}  // namespace

ContactCorners::ContactCorners(const JointEquations& equations, bool interference_alone)
    : n_planes_(equations.n_planes()) {
  for (const Contact& plane : equations.contacts) remembers_.push_back(plane.law->remembers());
  for (const PlacedInterface& placed : equations.interfaces) {
    auto corners = placed.interface->corners();
    for (Index entry = 0; entry < std::ssize(corners); ++entry) {
      const Index rim = (std::ssize(corners_) - n_planes_) / 2;
      const bool wanted =
          !interference_alone || (!corners[entry].empty() && corners[entry][0].kind == CornerKind::part &&
                                  equations.rims[rim]->contact().gap() < 0);
      corners_.push_back(wanted ? std::move(corners[entry]) : std::vector<Corner>());
      at_.emplace_back(&placed, entry);
    }
  }
}

double ContactCorners::position(const VectorXd& c, Index entry) const {
  const auto& [placed, number] = at_[entry];
  return placed->interface->position(c.segment(placed->row, placed->interface->size()), number);
}

VectorXd ContactCorners::slope(const VectorXd& c, Index entry) const {
  const auto& [placed, number] = at_[entry];
  const Index n = placed->interface->size();
  VectorXd result = VectorXd::Zero(c.size());
  result.segment(placed->row, n) = placed->interface->slope(c.segment(placed->row, n), number);
  return result;
}

double ContactCorners::nearness(const VectorXd& c, double at) {
  constexpr double of_corner = 1e-9, of_largest = 1e-10;
  return of_corner * at + of_largest * c.cwiseAbs().maxCoeff();
}

VectorXi ContactCorners::passed(const VectorXd& c) const {
  VectorXi result = VectorXi::Zero(std::ssize(corners_));
  for (Index j = 0; j < result.size(); ++j) {
    const auto& own = of(j);
    if (own.empty()) continue;
    const double x = this->position(c, j);
    const bool mirrored = x < 0 && !at_[j].first->interface->is_one_sided(at_[j].second);
    const double position = mirrored ? -x : x;
    const int reached = int(std::count_if(own.begin(), own.end(), [&](const Corner& corner) {
      if (corner.kind == CornerKind::touch) return x >= corner.at;
      return position >= corner.at - nearness(c, corner.at);
    }));
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

std::vector<ContactEvent> ContactCorners::at(const VectorXd& before, const VectorXi& passed_before,
                                             const VectorXd& c) const {
  std::vector<ContactEvent> result;
  for (Index j = 0; j < n_planes_ && !c.isZero(0); ++j) {
    const double x = position(c, j), was = position(before, j);
    const double sign = x < 0 && !at_[j].first->interface->is_one_sided(at_[j].second) ? -1 : 1;
    for (const Corner& corner : of(j)) {
      const double near = nearness(c, corner.at);
      if (std::abs(sign * x - corner.at) > near || std::abs(sign * was - corner.at) <= near) continue;
      result.push_back({j, corner.kind, sign * was > corner.at});
    }
  }
  const VectorXi here = passed(c);
  VectorXi rims_before = passed_before;
  rims_before.head(n_planes_) = here.head(n_planes_);
  const auto of_rims = between(rims_before, here);
  result.insert(result.end(), of_rims.begin(), of_rims.end());
  return result;
}

void ContactCorners::leave_to_memory(std::vector<ContactEvent>& events, bool onward_too) const {
  std::erase_if(events, [&](const ContactEvent& event) {
    const bool of_slider = event.kind == CornerKind::slip || event.kind == CornerKind::yield;
    return event.plane < n_planes_ && remembers_[event.plane] && of_slider && (event.back || onward_too);
  });
}

std::string event_text(const JointModel& joint, const std::vector<ContactEvent>& events) {
  const auto rims = joint.rims();
  const auto name = [&](const ContactEvent& event) {
    const Index entry = event.plane - joint.n_planes();
    return entry < 0 ? joint.short_name(joint.planes[event.plane]) : rims[entry / 2];
  };
  std::vector<std::string> parts;
  for (const bool back : {false, true})
    for (const Words& each : words) {
      std::vector<std::string> names;
      for (const auto& event : events)
        if (event.kind == each.kind && event.back == back) names.push_back(name(event));
      if (names.empty()) continue;
      const auto& verb = back ? each.back : each.onward;
      parts.push_back(fmt::format("{} {}", fmt::join(names, ", "), verb[names.size() == 1 ? 0 : 1]));
    }
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace fastjoint::stage3
