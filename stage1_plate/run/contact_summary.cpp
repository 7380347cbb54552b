// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/run/contact_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/program/program.hpp"

namespace fastjoint::stage1 {
namespace {

std::string arcs_text(const HoleContact& contact) {
  if (contact.arcs.empty()) return "no contact";
  std::vector<std::string> arcs;
  for (const auto& arc : contact.arcs)
    arcs.push_back(fmt::format("{:.2f}..{:.2f}", arc.from / rim::degree, arc.to / rim::degree));
  const std::string all = fmt::format("contact {} degrees", fmt::join(arcs, ", "));
  return contact.half_angle > 0 ? fmt::format("{} (half-angle {:.2f})", all, contact.half_angle / rim::degree) : all;
}

}  // namespace

std::string contact_summary(const PlateScene& scene, const ContactState& state) {
  std::string text;
  for (const auto& contact : state.holes) {
    text += fmt::format("  hole {}: {}, {}", scene.holes[contact.hole].id, arcs_text(contact),
                        program::counted(contact.iterations, "iteration"));
    if (!contact.arcs.empty())
      text += fmt::format(", peak pressure {:.6g} at {:.2f} degrees", contact.peak_pressure,
                          contact.peak_angle / rim::degree);
    text += "\n";
  }
  return text;
}

}  // namespace fastjoint::stage1
