// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/fastener_gaps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

namespace fastjoint::stage3 {
namespace {

/// Input to write instead of clearances, "write "gap": 0.03 instead".
std::string advice(const std::vector<double>& gaps) {
  if (gaps.empty())
    return "gaps that add up to the clearance in the two holes of each shear plane and are 0 in holes whose springs "
           "act in tension too, or other springs";
  std::vector<std::string> texts;
  for (const double gap : gaps) texts.push_back(fmt::format("{:.12g}", gap));  // halves in full
  const bool one = std::ranges::all_of(texts, [&](const auto& text) { return text == texts[0]; });
  return fmt::format("0, or write \"gap\": {} instead, which lets the sheets move as far before the fastener bears",
                     one ? texts[0] : fmt::format("[{}]", fmt::join(texts, ", ")));
}

}  // namespace

double gap_of(const FastenerScene& fastener, Index at, const PlateModel& plate) {
  if (!fastener.diameter) return fastener.gap.empty() ? 0 : fastener.gap[at];
  const auto rim = std::ranges::find(plate.contact, fastener.between[at].name, &formats::ContactRim::hole);
  const double of_sheet = rim == plate.contact.end() ? std::numeric_limits<double>::infinity() : 2 * rim->radius;
  return ((fastener.hole_diameter.empty() ? of_sheet : fastener.hole_diameter[at]) - *fastener.diameter) / 2;
}

void check_gap(const FastenerScene& fastener, const std::string& hole, const PlateModel& plate, double gap) {
  if (gap != 0 && !plate.is_in_contact(hole))
    refuse(fastener.where_gap(),
           fmt::format("the springs of hole \"{}\" of {} act in tension too and leave no gap", hole, plate.file),
           "a gap in holes with \"compression_only\", \"clearance\" in others");
}

std::vector<double> equal_gaps(const std::vector<double>& clearance, const std::vector<bool>& in_contact) {
  // Every gap is offset + sign s with s the first gap, since neighbours add up to their clearance. The ground counts as
  // a last hole without a gap.
  const Index n = std::ssize(clearance) + 1;
  std::vector<double> offset(n, 0), sign(n, 1);
  double low = 0, high = std::numeric_limits<double>::infinity();
  const double rounding = 1e-12 * *std::ranges::max_element(clearance);
  for (Index i = 0; i < n; ++i) {
    if (i > 0) offset[i] = clearance[i - 1] - offset[i - 1], sign[i] = -sign[i - 1];
    const double at_zero = -sign[i] * offset[i];  // s at which this gap is 0
    const bool filled = i == std::ssize(in_contact) || !in_contact[i];
    if (filled || sign[i] > 0) low = std::max(low, at_zero);
    if (filled || sign[i] < 0) high = std::min(high, at_zero);
  }
  if (low > high + rounding) return {};
  const double s = (low + high) / 2;
  std::vector<double> gaps;
  for (Index i = 0; i < std::ssize(in_contact); ++i) {
    const double gap = offset[i] + sign[i] * s;
    gaps.push_back(gap > rounding ? gap : 0);
  }
  return gaps;
}

void check_clearance(const JointModel& model, const FastenerScene& scene, const FastenerModel& fastener) {
  std::vector<bool> in_contact;
  for (const auto& hole : fastener.holes) {
    const PlateModel& plate = model.plates[hole.plate];
    in_contact.push_back(plate.is_in_contact(plate.hole_of(hole.disc)));
  }
  for (Index plane = 0; plane < std::ssize(scene.clearance); ++plane) {
    if (scene.clearance[plane] == 0) continue;
    for (Index hole = plane; hole < std::min(plane + 2, std::ssize(fastener.holes)); ++hole)
      if (in_contact[hole])
        refuse(scene.where + "/clearance",
               fmt::format("{} is free play of a law, but hole \"{}\" has compression-only springs: the free play of "
                           "such holes is their \"gap\"",
                           scene.clearance[plane], model.name(fastener.holes[hole])),
               advice(equal_gaps(scene.clearance, in_contact)));
  }
}

}  // namespace fastjoint::stage3
