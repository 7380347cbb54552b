// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/formats/plate_matrices.hpp"
#include "stage3_nonlinear/model/bearing_side.hpp"
#include "stage3_nonlinear/model/contact_rims.hpp"
#include "stage3_nonlinear/model/spring_waves.hpp"
#include "stage3_nonlinear/scene/joint_scene.hpp"

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The matrices of a plate at its last degrees up to that of the joint, ascending; S, T, R are those of PlateModel.
struct PlateDegrees {
  Eigen::VectorXi p;
  std::vector<MatrixXd> S, T;
  std::vector<MatrixXd> C;  ///< (q, q) C_t, length / force
  std::vector<MatrixXd> R;  ///< only those of the last two degrees
};

/// A plate at one degree p. Its unknowns u are the displacements of its m discs, hole after hole, those of its e rigid
/// externals, and the k contact moments of the rims with compression-only springs (RimContact).
///
/// The external forces in equilibrium with them are S u + R Lambda + T f (docs/theory.md, section 4). S does not hold
/// the springs of a rim of contact: the force that they transmit is minus the force on its moments.
struct PlateModel {
  std::string name, file;
  std::string materials;                                 ///< JSON text of them in its PLATE.json; empty if unknown
  std::string matrices_digest, plate_digest;             ///< of its MATRICES.h5, and of its PLATE.h5
  std::vector<std::string> holes, externals, tractions;  ///< (m / a), (e), (q): each side of a hole is a case
  std::vector<int> axes;                                 ///< (a) directions of each hole's discs in order: 0 x, 1 y
  std::vector<Index> discs;                              ///< of m, those in the file: symmetry fixes the others
  std::vector<bool> on_springs;                          ///< (m / a) the plate's own bearing is in S
  std::vector<formats::ContactRim> contact;              ///< (g) rims with compression-only springs
  MatrixXd S;                                            ///< (m+e+k, m+e+k), force / length
  /// (m+e+k, h + s) by friction cases, then by the shears of rims of contact, length^2
  MatrixXd R;
  MatrixXd T;                                        ///< (m+e+k, q), dimensionless
  std::vector<std::string> friction_hole;            ///< (h)
  std::vector<BearingSide> friction_bearing;         ///< (h)
  VectorXd friction_unit_force, friction_resultant;  ///< (h), length^2
  VectorXd friction_resultant_across;                ///< (h), length^2; empty: all 0
  VectorXd traction_resultant_across;                ///< (q), dimensionless; empty: all 0
  std::vector<int> external_axis, traction_axis;     ///< (e), (q) 0 x, 1 y; any of a moment
  std::vector<double> traction_arm{};                ///< (q) a moment over its force, length; 0 of a force
  formats::Places places{};                          ///< of the discs of the file, externals, tractions and supports
  std::vector<int> unsupported_axes;                 ///< axes along which no support of stage 1 reacts
  PlateDegrees degrees;                              ///< their sequence shows the error of S
  MatrixXd S_error;  ///< (m+e+k, m+e+k) from the file; infinite if it has none or p is not its highest degree
  formats::PlateStresses stresses;  ///< as the file has them
  std::optional<int> stress_level;  ///< those of the joint's degree, if there are any
  formats::Border border{};
  formats::CrackRows cracks{};            ///< rows of the joint's degree alone
  std::vector<formats::WaveRim> waves{};  ///< rims with waves of the elements: those of contact, then others
  std::vector<std::shared_ptr<const ShortWaves>> short_waves{};    ///< (g) the waves of higher order, in closed form
  std::vector<std::shared_ptr<const SpringWaves>> spring_waves{};  ///< of each of `waves`, if it has stresses
  std::vector<MatrixXd> wave_rows{};         ///< PlateCases::W of all rims at the joint's degree and the one before
  bool peaks_alone = false;                  ///< no errors of hoop stresses and no check of friction against the slip
  Index file_unit_cases = 0;                 ///< number of unit cases of the file, the columns of wave_rows
  Index n_loaded_waves = 0;                  ///< of which this many are waves of contact
  std::vector<std::string> traction_hole{};  ///< (q) hole that each traction presses on, "" for an edge
  VectorXd traction_unit_force{};            ///< (q) force per unit peak of its cosine pressure, length^2
  VectorXd expansion{};                      ///< (3) formats::UnitCases::expansion
  /// (q) side of the hole that bears under the force of this case; none or no list for edges
  std::vector<BearingSide> traction_bearing{};

  /// True if a traction is a moment.
  [[nodiscard]] bool is_moment(Index traction) const {
    return traction < std::ssize(traction_arm) && traction_arm[traction] > 0;
  }
  /// Sign of the force under which a traction's side of its hole bears; 0 for edges.
  [[nodiscard]] int bearing_sign(Index traction) const {
    if (traction >= std::ssize(traction_bearing) || !traction_bearing[traction]) return 0;
    return traction_bearing[traction]->sign;
  }
  /// True if a traction case is the other side of the hole of the case before.
  [[nodiscard]] bool is_other_side(Index traction) const {
    return traction > 0 && traction < std::ssize(tractions) && tractions[traction] == tractions[traction - 1];
  }
  /// m: unknowns of the discs.
  [[nodiscard]] Index n_discs() const { return holes.size() * axes.size(); }
  [[nodiscard]] Index n_externals() const { return externals.size(); }
  /// True if the hoop stress around a hole is known, which it is not where a crack or another boundary cuts its rim.
  [[nodiscard]] bool has_peak(const std::string& hole) const {
    const auto is = [&](const formats::WaveRim& rim) { return rim.hole == hole && rim.has_closed_form(); };
    return std::ranges::any_of(waves, is);
  }
  /// Hole of a disc unknown.
  [[nodiscard]] const std::string& hole_of(Index disc) const { return holes[disc / axes.size()]; }
  [[nodiscard]] int axis_of(Index disc) const { return axes[disc % axes.size()]; }
  [[nodiscard]] Index n_unknowns() const { return S.rows(); }
  /// True if a hole has compression-only springs.
  [[nodiscard]] bool is_in_contact(const std::string& hole) const {
    return std::ranges::find(contact, hole, &formats::ContactRim::hole) != contact.end();
  }
  /// False if a line of symmetry fixes this displacement of the hole's disc.
  [[nodiscard]] bool has_disc(Index disc) const { return std::ranges::binary_search(discs, disc); }
  /// Column of R of the first shear of a rim of contact.
  [[nodiscard]] Index first_shear(const formats::ContactRim& rim) const {
    Index first = std::ssize(friction_hole);
    for (Index before = 0; before < &rim - contact.data(); ++before) first += waves[before].waves.n_shears();
    return first;
  }
  /// First unknown of the moments of contact.
  [[nodiscard]] Index first_moment() const { return n_discs() + n_externals(); }
};

/// The matrices at degree p, checked: names are unique, S is symmetric and positive semi-definite. Throws FileError or
/// InputError with the file and the dataset.
/// @param axes Those of the joint; the file's own if empty.
[[nodiscard]] PlateModel make_plate(const std::string& name, const std::string& file, formats::PlateMatrices matrices,
                                    int p, const std::vector<int>& axes = {});

/// Entry i of a list; an empty list stands for zeros.
[[nodiscard]] inline double entry_or_0(const VectorXd& list, Index i) { return list.size() == 0 ? 0 : list[i]; }

/// Directions of the discs of all files, in the order of the first hole that has both, else x before y; 0 x, 1 y.
/// Throws FileError for a word that is no direction.
[[nodiscard]] std::vector<int> joint_axes(std::span<const std::string> files,
                                          std::span<const formats::PlateMatrices> all);

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
