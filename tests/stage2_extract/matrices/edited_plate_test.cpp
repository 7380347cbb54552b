// SPDX-License-Identifier: GPL-3.0-or-later
// PLATE.h5 files that someone has edited: what no plate can have is refused with its dataset.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <hdf5.h>

#include <functional>
#include <limits>

#include "common/errors.hpp"
#include "tests/support/files.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using formats::PlateSolution;
using testing::HasSubstr;
using testing::ThrowsMessage;

class EditedPlate : public testing::Test {
 protected:
  void refused(const std::function<void(PlateSolution&)>& edit, const std::string& message) const {
    PlateSolution plate = good_;
    edit(plate);
    const test::TemporaryFolder folder;
    const std::string path = folder.path("plate.h5");
    formats::write(path, plate);
    EXPECT_THAT([&] { (void)formats::read_plate_solution(path); },
                ThrowsMessage<FileError>(HasSubstr(fmt::format("plate.h5:{}", message))));
  }

  PlateSolution good_ = test::solve(test::make_plate(test::grid_scene(
      {0, 1}, {0, 1}, {{"a", 0.5, 0.5, 0.2}}, R"(, "p": [2, 3], "supports": [{"on": "left", "fix": ["x", "y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                 {"id": "T", "on": "top", "direction": "y", "kind": "traction"}])")));
};

TEST_F(EditedPlate, DirectionsAndSides) {
  refused([](auto& a) { a.disc_direction[0] = std::string("z"); }, "disc/direction: holds \"z\", expected one of x, y");
  refused([](auto& a) { a.external_direction[0] = ""; }, "external/direction: holds \"\"");
  refused([](auto& a) { a.traction_direction[0] = std::string("X"); }, "traction/direction: holds \"X\"");
  refused([](auto& a) { a.friction_bearing[1] = std::string("x"); },
          "friction/bearing: holds \"x\", expected one of +x, -x, +y, -y");
  refused([](auto& a) { a.sections.at(0).side = ""; }, "section/side: holds \"\"");
}

TEST_F(EditedPlate, Degrees) {
  refused([](auto& a) { a.p << 3, 2; }, "p: holds 3, 2, expected ascending degrees from 1 to 8");
  refused([](auto& a) { a.p[1] = 9; }, "p: holds 9, expected");
}

TEST_F(EditedPlate, NumbersOfUnknowns) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("plate.h5");
  formats::write(path, good_);
  const auto overwrite = [&](int at_2, int at_3) {
    const int numbers[] = {at_2, at_3};
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), set = H5Dopen2(file, "ndof", H5P_DEFAULT);
    H5Dwrite(set, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers);
    H5Dclose(set);
    H5Fclose(file);
  };
  const auto complaint = [&](const std::string& message) {
    EXPECT_THAT([&] { (void)formats::read_plate_solution(path); }, ThrowsMessage<FileError>(HasSubstr(message)));
  };
  overwrite(5, 4);
  complaint("plate.h5:ndof: holds 5, 4, expected numbers that do not fall");
  overwrite(-1, 4);
  complaint("plate.h5:ndof: holds -1, expected");
}

TEST_F(EditedPlate, IndicesThatNameNothing) {
  refused([](auto& a) { a.mesh.quads(0, 0) = a.mesh.n_nodes(); }, "mesh/quads: holds ");
  refused([](auto& a) { a.mesh.arcs[0].b = -1; }, "mesh/arc_nodes: holds -1, expected integers from 0 to ");
  refused([](auto& a) { a.mesh.material[0] = 1; }, "mesh/material: holds 1, expected integers from 0 to 0");
  refused([](auto& a) { a.unknown(0, 0) = a.ndof[1]; }, "unknown: holds ");
  refused([](auto& a) { a.unknown(0, 0) = -2 - static_cast<int>(a.held_stiffness.size()); }, "unknown: holds -");
  refused([](auto& a) { a.hole_rim[0].sides[0].element = a.mesh.n_elements(); }, "hole/rim: names side ");
  refused([](auto& a) { a.sections.at(0).sides.at(0).local_edge = 4; }, "section/sides: names side 4 of element ");
  refused([](auto& a) { a.sections.at(0).hole = 1; }, "section/hole: holds 1, expected integers from 0 to 0");
  refused([](auto& a) { a.friction_hole[0] = ""; }, "friction/hole: holds \"\", expected names in hole/id");
  refused([](auto& a) { a.traction_hole[0] = std::string("b"); }, "traction/hole: holds \"b\", expected");
}

TEST_F(EditedPlate, RowsOfASparseMatrix) {
  refused([](auto& a) { a.T_f.innerIndexPtr()[1] = a.T_f.innerIndexPtr()[0]; }, "T_f: is not a sparse matrix");
  refused([](auto& a) { a.T_f.innerIndexPtr()[0] = -1; }, "T_f: is not a sparse matrix");
  refused([](auto& a) { a.T_f.innerIndexPtr()[0] = a.ndof[1]; }, "T_f: is not a sparse matrix of ");
}

TEST_F(EditedPlate, RimsThatAreNotArcsOfTheirCircle) {
  refused([](auto& a) { a.hole_rim[0].sides[0].local_edge ^= 1; }, "hole/rim: the sides of hole \"a\"");
  refused([](auto& a) { a.hole_rim[0].radius = 0; }, "hole/rim: the sides of hole \"a\"");
  refused([](auto& a) { a.hole_rim[0].sides.pop_back(); }, "hole/rim: the sides of hole \"a\"");
}

TEST_F(EditedPlate, InfiniteNumbers) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  refused([](auto& a) { a.cases[1].T(0, 0) = infinite; }, "p3/T: holds inf, expected finite numbers");
  refused([](auto& a) { a.hole_spring[0].acts[0].to = infinite; }, "hole/arc: holds inf");
}

}  // namespace
}  // namespace fastjoint
