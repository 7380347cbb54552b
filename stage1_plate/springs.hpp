// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage1_plate/assembler.hpp"

namespace fastjoint::stage1 {

/// The springs of a hole as stage 2 reads them: modulus 0 of an open hole.
[[nodiscard]] formats::HoleSpring spring_of(const Hole& hole);

/// Distributed normal springs between every rim and its rigid disc, equation (6): adds int k t (v.n)(u.n) ds to the
/// plate, -int k t (u.n)(e.n) ds between plate and disc, int k t (e.n)(e'.n) ds to the disc.
void add_springs(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering,
                 const Unknowns& unknowns, Assembler& assembler);

}  // namespace fastjoint::stage1
