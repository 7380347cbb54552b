// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "stage3_nonlinear/contact_event.hpp"
#include "stage3_nonlinear/walk.hpp"

namespace fastjoint::stage3 {

/// Something happens here.
struct EventPlace {
  Place place;
  int iterations = 0;
  std::vector<ContactEvent> events;
};

/// Searches the load factors between first_load_factor (event_path.hpp) and 1 for events by states that `walk` solves.
///
/// @param scale  Force that residuals are relative to.
/// @param events Takes what is found, ascending.
/// @return       A load factor that `walk` could not reach; then events before it only are sure.
[[nodiscard]] std::optional<double> search_events(const JointEquations& equations, const PathOptions& options,
                                                  const ContactMarks& marks, double scale, Walk& walk,
                                                  std::vector<EventPlace>& events);

}  // namespace fastjoint::stage3
