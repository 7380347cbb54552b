// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stage3_nonlinear/model/plate_model.hpp"
#include "stage3_nonlinear/scene/joint_scene.hpp"

namespace fastjoint::stage3 {

/// Side of a rim that bears, under a bearing force on the plate along + or - the axis.
enum Side : Index { plus_side, minus_side };

/// Friction of a hole while one of its sides bears, per unit of its peak shear stress.
struct FrictionCase {
  Index column = -1;      ///< of PlateModel::R; -1 where no rim can bear
  double unit_force = 0;  ///< c: force of bearing, length^2
  double resultant = 0;   ///< magnitude of the friction force along the direction, length^2
  double across = 0;      ///< component of that force along the other axis, carried by the disc, length^2
};

/// A hole of a plate with a fastener in it.
struct HoleModel {
  Index plate = 0;
  Index disc = 0;  ///< first unknown of its disc among the plate's
  /// True if it may have friction in a run.
  bool has_friction = false;
  /// Friction by direction of the joint, then by Side: each component of the bearing force has its own friction case.
  /// Empty without friction, and at a rim of contact, whose friction follows its pressure (RimFriction).
  std::vector<std::array<FrictionCase, 2>> friction{};
};

/// A fastener through its holes in their order.
struct FastenerModel {
  std::string id;
  std::vector<HoleModel> holes;
  bool law_includes_friction = false;  ///< the laws give the transferred load, not the bearing force alone
  bool grounded = false;               ///< its last plane is between the last hole and the fixed ground

  [[nodiscard]] Index n_planes() const { return std::ssize(holes) - (grounded ? 0 : 1); }
};

/// Plane between two neighbouring holes of a fastener: delta = D(first) - D(second). The force on the second plate is
/// +F, that on the first -F. The second may be the ground, D = 0.
struct ShearPlane {
  Index fastener = 0;
  Index first = 0;  ///< hole of the fastener; the second is the next, or the ground after the last
  std::string law_name;
  bool one_sided = false;
};

/// Plates and fasteners, with indices instead of names: what is the same in all runs of a joint. The numbers of a run
/// are its Parameters.
///
/// Vectors of the shear planes have one entry for each plane and direction, directions inner.
struct JointModel {
  std::string file;  ///< of the joint, for messages
  Units units;
  int p = 0;
  std::vector<int> axes{0};  ///< (a) directions of all discs: 0 x, 1 y
  std::vector<PlateModel> plates;
  std::vector<FastenerModel> fasteners;
  std::vector<ShearPlane> planes;

  [[nodiscard]] Index n_directions() const { return axes.size(); }
  [[nodiscard]] Index n_planes() const { return planes.size(); }
  /// Number of contact moments of each rim of contact, plate after plate, and their sum.
  [[nodiscard]] std::vector<Index> rim_sizes() const;
  [[nodiscard]] Index n_moments() const;
  /// "x" or "y": direction d of the discs.
  [[nodiscard]] const std::string& axis_name(Index d) const { return rim::axis_names[axes[d]]; }
  /// First unknown of a plate in the joint's list, plate after plate.
  [[nodiscard]] Index offset(Index plate) const;
  [[nodiscard]] Index n_unknowns() const { return offset(plates.size()); }
  [[nodiscard]] const HoleModel& first_hole(const ShearPlane& plane) const {
    return fasteners[plane.fastener].holes[plane.first];
  }
  /// Hole on the other side of a plane that is not to the ground.
  [[nodiscard]] const HoleModel& second_hole(const ShearPlane& plane) const {
    return fasteners[plane.fastener].holes[plane.first + 1];
  }
  /// Index of the first hole of a plane among all holes of fasteners, fastener after fastener.
  [[nodiscard]] Index number_of_first_hole(const ShearPlane& plane) const;
  /// Holes of the plane: the first alone if it is to the ground.
  [[nodiscard]] std::span<const HoleModel> holes(const ShearPlane& plane) const {
    return {&first_hole(plane), is_to_ground(plane) ? 1U : 2U};
  }
  [[nodiscard]] bool is_to_ground(const ShearPlane& plane) const {
    return plane.first + 1 == std::ssize(fasteners[plane.fastener].holes);
  }
  /// Index of a hole among those that its plate's matrices describe; none if they do not.
  [[nodiscard]] std::optional<Index> described(const HoleModel& hole) const;
  /// "plate:hole" of each rim of contact, plate after plate.
  [[nodiscard]] std::vector<std::string> rims() const;
  /// "plate:hole"
  [[nodiscard]] std::string name(const HoleModel& hole) const;
  /// Name in messages: fastener "1", and of one with several planes also the plates: fastener "1" between "a" and "b".
  [[nodiscard]] std::string name(const ShearPlane& plane) const;
  /// Name in tables: 1, and of one with several planes 1 (a-b).
  [[nodiscard]] std::string short_name(const ShearPlane& plane) const;
};

/// Reads the matrices of all plates, resolves every name, and checks the numbers of all cases.
///
/// @param p Degree, or 0 for the highest that all plates have.
/// Throws FileError, or InputError with the place in the joint's file or the dataset of a plate's.
[[nodiscard]] JointModel load_joint(const JointScene& scene, int p);

}  // namespace fastjoint::stage3
