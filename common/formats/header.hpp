// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <numeric>
#include <string>
#include <type_traits>
#include <vector>

#include "common/h5/reader.hpp"
#include "common/h5/writer.hpp"
#include "common/pfem/mesh.hpp"
#include "common/pfem/shape_functions.hpp"
#include "common/rim/elastic_disk.hpp"
#include "common/rim/harmonics.hpp"
#include "common/units.hpp"

namespace fastjoint::formats {

// Every format is one function template, such as `matrices_datasets(file, a)`, for an h5::Writer and an h5::Reader.
// Each of its lines has the name of a dataset, the value in memory, shape, unit and meaning, and the values that a
// reader allows.

/// Attributes and input text that every file has.
struct Header {
  std::string generator;  ///< program and version
  std::string name;       ///< name of the plate or joint
  Units units;
  std::string input;     ///< JSON text that the file was made from
  std::string digest{};  ///< digest of the file that this was read from; empty if it has none
};

/// A rim with compression-only springs, and the basis of its contact pressures.
struct ContactRim {
  std::string hole;
  rim::Harmonics pressures;  ///< of highest order 0: as many as a joint asks for
  double modulus;            ///< K of the springs, force / length^3
  double radius;             ///< length
  double area;               ///< thickness times length of the rim in the model, length^2
  rim::ElasticDisk disk{};   ///< elastic pin in place of the springs; without one the springs press on the rim
};

/// A rim with waves that the finite elements resolve: displacements, and in contact tractions too.
struct WaveRim {
  std::string hole;
  rim::Harmonics waves;
  double radius;   ///< length
  double area;     ///< thickness times length of the rim in the model, length^2
  double modulus;  ///< K of the springs, 0 for an open hole, force / length^3
  /// Strains (x, y, xy) of the sheet at the rim per unit stress, 1 / stress; 0 if there is no closed form, because
  /// material or thickness vary around the rim, or it is neither whole nor a part between lines of symmetry.
  Eigen::Matrix3d compliance = Eigen::Matrix3d::Zero();
  std::vector<rim::AngleRange> acts{};  ///< parts of the rim on which springs act

  [[nodiscard]] bool has_closed_form() const { return compliance(0, 0) > 0; }
  /// Number of pressures and shears.
  [[nodiscard]] Eigen::Index size() const { return waves.size() + waves.n_shears(); }
};

/// Waves of a rim in contact that are used for stress fields; the elements do not resolve shorter ones well.
[[nodiscard]] inline rim::Harmonics waves_of_field(const ContactRim& rim, const WaveRim& carried) {
  constexpr int max_order = 16;
  rim::Harmonics waves = rim.pressures;
  const int highest = std::max(carried.waves.highest, max_order);
  waves.highest = waves.highest > 0 ? std::min(waves.highest, highest) : highest;
  return waves;
}

/// The outline of a sheet.
using Border = std::vector<pfem::OutlinePiece>;

/// A part of a sheet as a beam along an axis, between rows of fasteners and changes of its section. Properties are
/// means over the bay, holes filled.
struct Bay {
  std::string direction;           ///< "x" or "y"
  double from, to;                 ///< its ends, length
  double width, thickness;         ///< length
  double membrane, bending;        ///< E A of tension, force; E I of cylindrical bending, force length^2
  int held_from = 0, held_to = 0;  ///< 1 where a support or an external is on that end of the sheet
};

/// Places at which forces act on a plate; empty in a file before these had them.
struct Places {
  Eigen::MatrixXd disc = Eigen::MatrixXd(0, 2);            ///< (m, 2) x and y of each disc, length
  Eigen::MatrixXd external = Eigen::MatrixXd(0, 2);        ///< (e, 2) least and greatest coordinate along its direction
  Eigen::MatrixXd traction = Eigen::MatrixXd(0, 2);        ///< (q, 2) the same; of a moment 0
  Eigen::MatrixXd support = Eigen::MatrixXd(0, 2);         ///< (2, 2) of all supports along x, along y; 0 of none
  Eigen::MatrixXd support_middle = Eigen::MatrixXd(0, 2);  ///< (2, 2) the same of their middles

  [[nodiscard]] bool is_known() const { return support.rows() > 0; }
};

/// A plate with its degrees and unit cases, common to PLATE.h5 and MATRICES.h5: n_p degrees, e rigid externals, m discs
/// (hole x direction), k loaded waves (rim in contact; pressures, then shears), h friction cases (hole, direction,
/// bearing + then -) of other holes, q tractions.
struct UnitCases {
  Header header;
  pfem::Space space = pfem::Space::trunk;                    ///< of the finite elements
  Eigen::VectorXi p, ndof;                                   ///< (n_p)
  std::vector<std::string> disc_hole, disc_direction;        ///< (m)
  std::vector<std::string> external_id, external_direction;  ///< (e); "x" or "y"
  /// (q); a load in a hole has one case for each side in the model, both of a unit force along the direction. A
  /// negative force uses the second.
  std::vector<std::string> traction_id, traction_direction;
  std::vector<double> traction_arm{};  ///< (q) length; the moment `rotation` of a force f is f times this, else 0
  /// (2) where a sheet without any support is held against rigid motions, length; empty: it is not
  Eigen::VectorXd held_at{};
  Eigen::VectorXd traction_moment{};  ///< (q) of such a sheet: moment of each unit traction about that place, length
  std::vector<std::string> traction_bearing;  ///< (q) side of the hole that bears, "+x", ...; "" for edges
  std::vector<std::string> traction_hole{};   ///< (q) hole under cosine pressure, "" for an edge
  std::vector<ContactRim> contact{};          ///< in the order of the holes
  std::vector<WaveRim> waves{};               ///< rims of `contact`, then others in the order of the holes
  Border border{};                            ///< none in a file before these had one
  std::vector<Bay> bays{};                    ///< along x, then along y, ascending; none if not known
  Places places{};
  Eigen::VectorXd expansion{};                ///< (3) free strain x, y, xy (of the tensor) per degree; (0) not known
  std::vector<std::string> friction_hole;     ///< (h)
  std::vector<std::string> friction_bearing;  ///< (h) "+x", "-x", "+y", "-y"

  [[nodiscard]] Eigen::Index n_externals() const { return external_id.size(); }
  [[nodiscard]] Eigen::Index n_discs() const { return disc_hole.size(); }
  /// Number of waves of the rims before this one in `waves`.
  [[nodiscard]] Eigen::Index n_waves_before(Eigen::Index rim) const {
    return std::accumulate(waves.begin(), waves.begin() + rim, Eigen::Index{0},
                           [](Eigen::Index sum, const WaveRim& each) { return sum + each.size(); });
  }
  /// k, the number of waves of rims in contact, and the number of waves of all rims.
  [[nodiscard]] Eigen::Index n_loaded_waves() const { return n_waves_before(std::ssize(contact)); }
  [[nodiscard]] Eigen::Index n_waves() const { return n_waves_before(std::ssize(waves)); }
  [[nodiscard]] Eigen::Index n_friction_cases() const { return friction_hole.size(); }
  [[nodiscard]] Eigen::Index n_tractions() const { return traction_id.size(); }
  /// Number of unit cases; their order is externals, discs, loaded waves, friction, tractions.
  [[nodiscard]] Eigen::Index n_cases() const {
    return n_externals() + n_discs() + n_loaded_waves() + n_friction_cases() + n_tractions();
  }
};

/// What a reader fills in, or a writer writes.
template <class File, class T>
using Data = std::conditional_t<File::reads, T, const T>;

/// The attributes and the input text of every file. A reader compares units only if the file has labels of its units.
template <class File>
void header(File& file, Data<File, Header>& a);

/// Attributes and datasets of UnitCases but its header. Throws FileError for an unknown name of a space.
/// @param holes Names of the holes in a file of stage 1 alone; null for one that other programs may write too, which
/// may leave out what has a default.
template <class File>
void unit_case_datasets(File& file, Data<File, UnitCases>& a, const std::vector<std::string>* holes);

/// The datasets of UnitCases::contact, in a group (its name ends with "/") or in the root.
template <class File>
void contact_datasets(File& file, Data<File, std::vector<ContactRim>>& a, const Units& units,
                      const std::string& group = "");

/// The datasets of a Border, in a group (its name ends with "/") or in the root.
template <class File>
void border_datasets(File& file, Data<File, Border>& a, const Units& units, const std::string& group = "");

/// The datasets of UnitCases::bays, in a group (its name ends with "/") or in the root; a file has all or none.
template <class File>
void bay_datasets(File& file, Data<File, std::vector<Bay>>& a, const Units& units, const std::string& group = "");

/// The datasets of the tips of cracks, in a group (its name ends with "/") or in the root.
template <class File>
void tip_datasets(File& file, Data<File, std::vector<pfem::CrackTip>>& a, const Units& units,
                  const std::string& group = "", bool with_angle = true);

/// Highest degree of matrices, which may come from other sources than stage 2.
inline constexpr int highest_degree = 99;

/// Number of degrees, the highest ones, that include waves without tractions and section forces. Their difference
/// estimates errors.
inline constexpr Eigen::Index n_stress_degrees = 2;

/// Names of the sides of a hole.
inline const std::vector<std::string> side_names = {"+x", "-x", "+y", "-y"};

/// Direction of a traction that is a moment.
constexpr const char* rotation = "rotation";
/// Descriptions of the datasets of every file.
constexpr const char* traction_boundaries =
    "external boundaries under a given traction, uniform on edges, a cosine pressure in holes, or a moment";
constexpr const char* traction_arm = "moment per force of each traction whose direction is rotation, 0 of others";
/// Description of the dataset traction/bearing of every file.
inline constexpr const char* bearing_side =
    "side of the hole that bears, +x, -x, +y or -y, for each traction in a hole, empty for an edge";

/// Allows ascending degrees from 1 to `highest`.
[[nodiscard]] h5::Allowed degrees(int highest);

}  // namespace fastjoint::formats
