// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "common/infinite.hpp"
#include "stage3_nonlinear/results/bending.hpp"

namespace fastjoint::stage3 {

namespace {

/// The larger or the smaller of the heads that were computed; NaN if one of them is not known.
double of_heads(const MatrixXd& all, const std::array<bool, 2>& computed, Index row, bool larger) {
  if (!computed[0] || !computed[1]) return all(row, computed[0] ? 0 : 1);
  return larger ? all.row(row).maxCoeff<Eigen::PropagateNaN>() : all.row(row).minCoeff<Eigen::PropagateNaN>();
}

}  // namespace

std::vector<PlateGroup> bending_quantities(const PlateModel& plate) {
  using namespace columns;
  if (!plate.bends) return {};
  const Index rows = std::ssize(disc_rows(plate)), r = plate.stress_level ? std::ssize(plate.stresses.rim_hole) : 0,
              t = std::ssize(plate.cracks.tips);
  const std::vector<std::string> heads{"free", "clamped"};
  const auto values = [](Index n, auto get) {
    return [n, get](const PlateAt& at) -> MatrixXd {
      const PlateBending& its = at.state().bending;
      const std::vector<MatrixXd> all = get(its);
      MatrixXd result(n, std::ssize(all));
      for (Index i = 0; i < result.cols(); ++i)
        result.col(i) =
            all[i].size() == n ? VectorXd(all[i].transpose().reshaped()) : VectorXd::Constant(n, std::nan(""));
      return result;
    };
  };
  std::vector<PlateGroup> groups{
      {Of::row,
       rows,
       {{"row/moment", {1, 1}, "moment of secondary bending before and behind each row, E I w''", "", h5::nan_too}},
       values(4 * rows, [](const PlateBending& its) { return std::vector{its.moment}; }),
       {{"before, free", "before, clamped", "behind, free", "behind, clamped"}}},
      {Of::row,
       rows,
       {{"row/k_b", ratio, "bending stress over the mean stress on the more loaded side of each row", "", h5::nan_too},
        {"row/deflection", length, "deflection of each row", "", h5::nan_too}},
       values(2 * rows,
              [](const PlateBending& its) {
                return std::vector{its.k_b, its.deflection};
              }),
       heads},
      {Of::row,
       rows,
       {{"row/pressed", ratio, "1 where free heads would press the sheet into its neighbour, which its faces prevent"}},
       values(rows, [](const PlateBending& its) { return std::vector<MatrixXd>{its.pressed}; })},
      {Of::external,
       plate.n_externals(),
       {{"bending/De", length, "displacement of each external with secondary bending", "", h5::nan_too},
        {"bending/Pe", force, "force on each external with secondary bending", "", h5::nan_too}},
       values(2 * plate.n_externals(),
              [](const PlateBending& its) {
                return std::vector{its.De, its.Pe};
              }),
       heads},
      {Of::tip,
       t,
       {{"crack/bending", ratio, "bending stress over the mean stress at the row next to each tip", "", h5::nan_too}},
       values(2 * t, [](const PlateBending& its) { return std::vector{its.at_tip}; }),
       heads},
      {Of::hole,
       r,
       {{"bending/stress", stress, "bending stress beside the hole, on the face with the larger peak", "", h5::nan_too},
        {"bending/lower", stress, "largest hoop stress with bending on the lower face", "", h5::nan_too},
        {"bending/lower_angle", angle, "its angle, counter-clockwise from x", "", h5::nan_too},
        {"bending/upper", stress, "largest hoop stress with bending on the upper face", "", h5::nan_too},
        {"bending/upper_angle", angle, "its angle, counter-clockwise from x", "", h5::nan_too}},
       values(2 * r,
              [](const PlateBending& its) {
                return std::vector{its.stress, its.lower, its.lower_angle, its.upper, its.upper_angle};
              }),
       heads},
      {Of::hole,
       r,
       {{"bending/peak", stress, "largest hoop stress with bending: the larger of both faces and both kinds of heads",
         "bent_peak", h5::nan_too,
         Output{"bent_peak", "bending", "largest hoop stress with bending at each hole",
                "largest hoop stress with bending of all"}},
        {"bending/peak_smaller", stress, "the same for the heads for which it is smaller", "bent_peak_smaller",
         h5::nan_too}},
       values(r, [](const PlateBending& its) {
         const MatrixXd faces = its.lower.cwiseMax(its.upper);
         std::vector<MatrixXd> all{MatrixXd(faces.rows(), faces.rows() > 0 ? 1 : 0)};
         all.push_back(all[0]);
         for (Index i = 0; i < faces.rows(); ++i) {
           all[0](i, 0) = of_heads(faces, its.computed, i, true);
           all[1](i, 0) = of_heads(faces, its.computed, i, false);
         }
         return all;
       })}};
  groups[0].extents = {2, 2};
  return groups;
}

std::vector<JointGroup> bending_quantities(const JointModel& joint) {
  using namespace columns;
  if (joint.plates.empty() || !joint.plates.front().bends) return {};
  const auto flat = [](const MatrixXd& all) { return VectorXd(all.transpose().reshaped()); };
  const std::vector<std::string> heads{"free", "clamped"};
  return {
      JointGroup(
          Of::plane, joint.n_planes(),
          {{"bending/transferred", force, "force that each plane transfers with secondary bending", "", h5::nan_too}},
          [flat](const JointAt& at) { return flat(at.state.bent_transferred); }, heads),
      JointGroup(
          Of::axis, 2,
          {{"bending/mismatch",
            ratio,
            "change of the moments along x and y by the last solution with the sheets displaced by bending, relative "
            "to the largest moment; NaN where it acts one way alone",
            "",
            {.text = "numbers", .low = -infinite, .high = infinite, .may_be_nan = true}}},
          [flat](const JointAt& at) { return flat(at.state.bending_mismatch); }, heads)};
}

}  // namespace fastjoint::stage3
