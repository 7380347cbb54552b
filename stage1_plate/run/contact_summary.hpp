// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "stage1_plate/contact/contact.hpp"

namespace fastjoint::stage1 {

/// One line for each hole with contact: where its springs push, how soon that was found, the largest pressure.
[[nodiscard]] std::string contact_summary(const PlateScene& scene, const ContactState& state);

}  // namespace fastjoint::stage1
