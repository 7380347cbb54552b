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

constexpr std::array words{
    Words{CornerKind::slip, {"slips", "slip"}, {"sticks again", "stick again"}},
    Words{CornerKind::contact, {"closes", "close"}, {"opens", "open"}},
    Words{CornerKind::yield, {"yields", "yield"}, {"is elastic again", "are elastic again"}},
    Words{CornerKind::touch, {"touches", "touch"}, {"opens", "open"}},
    Words{
        CornerKind::part, {"loses full contact", "lose full contact"}, {"is in full contact", "are in full contact"}}};

}  // namespace

ContactCorners::ContactCorners(const JointEquations& equations, bool interference_alone)
    : equations_(equations), n_planes_(equations.n_planes()), corners_(n_planes_) {
  for (Index j = 0; j < n_planes_ && !interference_alone; ++j) corners_[j] = corners_of(equations.contacts[j]);
  for (const auto& rim : equations.rims)
    for (const CornerKind kind : {CornerKind::touch, CornerKind::part}) {
      corners_.emplace_back();
      if (!interference_alone || (kind == CornerKind::part && rim.gap() < 0)) corners_.back().push_back({0, kind});
    }
}

double ContactCorners::position(const VectorXd& c, Index plane) const {
  const Index a = equations_.n_directions();
  if (plane < n_planes_) return a == 1 ? c[plane] : c.segment(plane * a, a).norm();
  const RimContact& rim = rim_of(plane);
  return slope(c, plane).dot(c) - sign_of(plane) * rim.stiffness() * rim.gap();
}

VectorXd ContactCorners::slope(const VectorXd& c, Index plane) const {
  const Index a = equations_.n_directions();
  VectorXd result = VectorXd::Zero(c.size());
  if (plane < n_planes_) {
    result.segment(plane * a, a) = a == 1 ? VectorXd::Ones(1) : VectorXd(c.segment(plane * a, a).normalized());
    return result;
  }
  const RimContact& rim = rim_of(plane);
  Index first = equations_.n_plane_rows();
  for (const RimContact* before = equations_.rims.data(); before != &rim; ++before) first += before->size();
  // The place of an extremum moves along the rim without changing it.
  const double angle = rim.deepest(c.segment(first, rim.size()), sign_of(plane));
  result.segment(first, rim.size()) = sign_of(plane) * rim.pressures().at(angle);
  return result;
}

double ContactCorners::nearness(const VectorXd& c, double at) {
  constexpr double of_corner = 1e-9, of_largest = 1e-10;
  return of_corner * at + of_largest * c.cwiseAbs().maxCoeff();
}

double ContactCorners::pressed(Index entry) const {
  constexpr double little = 1e-6;  // of the gap
  return little * rim_of(entry).stiffness() * std::max(rim_of(entry).gap(), 0.0);
}

VectorXi ContactCorners::passed(const VectorXd& c) const {
  VectorXi result = VectorXi::Zero(std::ssize(corners_));
  for (Index j = 0; j < result.size(); ++j) {
    const auto& own = of(j);
    if (own.empty()) continue;
    const double x = this->position(c, j);
    const bool mirrored = x < 0 && !is_one_sided(j);
    const double position = mirrored ? -x : x;
    const int reached = int(std::count_if(own.begin(), own.end(), [&](const Corner& corner) {
      if (corner.kind == CornerKind::touch) return x >= pressed(j);
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

std::vector<ContactEvent> ContactCorners::at(const VectorXd& before, const VectorXd& c) const {
  std::vector<ContactEvent> result;
  for (Index j = 0; j < n_planes_ && !c.isZero(0); ++j) {
    const double x = position(c, j), was = position(before, j);
    const double sign = x < 0 && !is_one_sided(j) ? -1 : 1;
    for (const Corner& corner : of(j)) {
      const double near = nearness(c, corner.at);
      if (std::abs(sign * x - corner.at) > near || std::abs(sign * was - corner.at) <= near) continue;
      result.push_back({j, corner.kind, sign * was > corner.at});
    }
  }
  const VectorXi here = passed(c);
  VectorXi rims_before = passed(before);
  rims_before.head(n_planes_) = here.head(n_planes_);
  const auto of_rims = between(rims_before, here);
  result.insert(result.end(), of_rims.begin(), of_rims.end());
  return result;
}

std::string event_text(const JointModel& joint, const std::vector<ContactEvent>& events) {
  const auto rims = joint.rims();
  const auto name = [&](const ContactEvent& event) {
    const Index behind = event.plane - joint.n_planes();
    return behind < 0 ? joint.short_name(joint.planes[event.plane]) : rims[behind / 2];
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
