// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "stage3_nonlinear/path/contact_event.hpp"
#include "stage3_nonlinear/path/walk.hpp"

namespace fastjoint::stage3 {

/// Load factors below this are not searched: what happens there is there from the start.
inline constexpr double first_load_factor = 1e-6;

/// Something happens here.
struct EventPlace {
  Place place;
  int iterations = 0;
  std::vector<ContactEvent> events;
};

/// What a search found.
struct FoundEvents {
  std::vector<EventPlace> events;  ///< ascending
  std::optional<double> failed;    ///< a load factor that could not be reached; the events are those before it
};

/// Searches the load factors between first_load_factor and 1 for events by states that `walk` solves.
[[nodiscard]] FoundEvents search_events(const JointEquations& equations, const ContactMarks& marks, Walk& walk);

}  // namespace fastjoint::stage3
