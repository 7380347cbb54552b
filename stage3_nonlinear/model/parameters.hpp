// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/model/free_shape.hpp"

namespace fastjoint::stage3 {

/// A load that a joint can carry, in the order of the plates, externals before tractions.
struct Load {
  Index plate;
  Index at;  ///< external, or first traction of its boundary
  bool is_traction;

  [[nodiscard]] bool operator==(const Load&) const = default;
};
[[nodiscard]] std::vector<Load> loads_of(const JointModel& joint);

/// How the externals of a joint are held in a run, on which its condensed system depends.
struct Held {
  std::vector<bool> displaced;  ///< each of loads_of: an external with a given displacement
  /// Groups of rigid externals that move as one, each by plate and external; the first carries the load of all.
  std::vector<std::vector<std::pair<Index, Index>>> ties = {};

  [[nodiscard]] bool operator==(const Held&) const = default;
};

/// A column of the condensed system: a load, or the part of a load on a hole that acts on one side of the hole.
struct LoadColumn {
  Index load;  ///< among loads_of
  Index plate;
  Index at;  ///< external, or traction
  bool is_traction, is_displacement;
  int sign = 0;  ///< 1 or -1: active while the load has this sign; 0: always active
};
[[nodiscard]] std::vector<LoadColumn> load_columns(const JointModel& joint, const Held& held);

/// Tells whether a load column with a sign is active under a load; a load of zero has the sign of its rate.
[[nodiscard]] inline bool is_active(int sign, double load, double rate = 0) {
  return sign != (load < 0 || (load == 0 && rate < 0) ? 1 : -1);
}

/// Numbers of one run of a joint, by index. All but `held` may change without a new condensed system. Only holes that
/// have friction in JOINT.json may have friction; planes with a common law there have a common law in a run too.
struct Parameters {
  VectorXd load;                ///< each of loads_of per unit of the load factor, force or length
  std::vector<LawPointer> law;  ///< (n) of each plane
  VectorXd clearance;           ///< (n) length
  VectorXd mu, gap;             ///< of each fastener in each of its holes, fastener after fastener; gap: length
  Held held = {};
  VectorXd load_before = {};         ///< loads at load factor 0, force or length; empty: none
  std::vector<FreeShape> free = {};  ///< of each plate, at every load factor
  // What follows from the free shapes; empty: none.
  VectorXd offset = {};      ///< (n a) relative displacements of the planes at which the sheets are free, length
  VectorXd free_given = {};  ///< each of loads_of: free displacement of an external that is displaced, length

  /// Loads that the input gives at a load factor.
  [[nodiscard]] VectorXd given_at(double load_factor) const {
    return load_before.size() > 0 ? VectorXd(load_before + load_factor * load) : VectorXd(load_factor * load);
  }
  /// Loads on the sheets at a load factor: displacements are those beyond their free shape.
  [[nodiscard]] VectorXd load_at(double load_factor) const {
    return free_given.size() > 0 ? VectorXd(given_at(load_factor) - free_given) : given_at(load_factor);
  }
  /// True if there are forces in the joint at load factor 0.
  [[nodiscard]] bool starts_loaded() const {
    return load_before.size() > 0 || offset.size() > 0 || free_given.size() > 0;
  }
};

/// The numbers of a load case in a scene that differs from the joint's only in numbers. Throws InputError where one is
/// not allowed.
[[nodiscard]] Parameters parameters_of(const JointModel& joint, const JointScene& scene, const CaseScene& its);
/// Sets the free shapes of all plates, and what follows from them with `held`.
void set_free_shapes(const JointModel& joint, std::vector<FreeShape> shapes, Parameters& all);

/// Indices of a rim of contact.
struct RimPlace {
  Index plate, at;  ///< among PlateModel::contact
  Index hole = -1;  ///< of all holes of fasteners, in the order of Parameters::gap; -1 without a fastener
  bool has_friction = false;
};
[[nodiscard]] std::vector<RimPlace> rim_places(const JointModel& joint);

}  // namespace fastjoint::stage3
