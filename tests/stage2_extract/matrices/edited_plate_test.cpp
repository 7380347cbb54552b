// SPDX-License-Identifier: GPL-3.0-or-later
// PLATE.h5 files that someone has edited: what no plate can have is refused with its dataset.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <hdf5.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "common/errors.hpp"
#include "stage2_extract/field/fields.hpp"
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

  PlateSolution good_ = test::solve(test::make_plate(
      test::grid_scene({0, 1}, {0, 1}, {{"a", 0.5, 0.5, 0.2}},
                       R"(, "p": [2, 3], "disc_directions": ["x", "y"], "supports": [{"on": "left", "fix": ["x", "y"]}],
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

/// Each is a good index by itself; together they would be written past the ends of lists, or never end.
TEST_F(EditedPlate, PlateUnknownsOnceAndInOrder) {
  const auto at = [&](int dof) {
    const auto* found = std::find(good_.unknown.data(), good_.unknown.data() + good_.unknown.size(), dof);
    return found - good_.unknown.data();
  };
  const int last = good_.ndof[1] - 1;
  const auto set = [&](std::initializer_list<std::pair<int, int>> changes, const std::string& message) {
    refused(
        [&](auto& a) {
          for (const auto& [from, to] : changes) a.unknown.data()[at(from)] = to;
        },
        "unknown: holds " + message);
  };
  set({{7, -1}}, "8 in row ");
  set({{last, -1}}, fmt::format("{} plate unknowns, expected {}", last, last + 1));
  set({{7, 3}}, "3 in row ");
  set({{last, 0}}, "0 in row ");
  set({{5, 6}, {6, 5}}, "6 in row ");
  refused([](auto& a) { a.ndof[1] += 1; }, "unknown: holds ");
}

TEST_F(EditedPlate, DiscsAndCasesOfTheSheet) {
  const auto pop = [](auto& a) {  // the last friction case
    a.friction_hole.pop_back();
    a.friction_bearing.pop_back();
    for (auto& level : a.cases) {
      level.R = level.R.leftCols(3).eval();
      const auto left = a.n_cases() - a.n_tractions();  // its own column stood behind them
      for (auto* rows : {&level.W, &level.N, &level.V}) {
        Eigen::MatrixXd rest(rows->rows(), a.n_cases());
        rest << rows->leftCols(left), rows->rightCols(a.n_tractions());
        *rows = rest;
      }
    }
    a.probe.friction = a.probe.friction.head(3).eval();
  };
  refused(pop, "friction/hole: case 3 of 3 is missing, expected \"a:-y\"");
  refused([](auto& a) { std::swap(a.friction_bearing[0], a.friction_bearing[1]); },
          "friction/hole: case 0 of 4 is \"a:-x\", expected \"a:+x\"");
  refused([](auto& a) { a.disc_direction[1] = std::string("x"); }, "disc/direction: hole \"a\" has x, x");
  refused([](auto& a) { a.disc_hole[1] = std::string("b"); }, "disc/hole: names 2 discs, expected 1: ");
  refused(
      [](auto& a) {
        a.points = {{0, 1, 1.0}};
      },
      "point/disc: holds 1, expected the discs after those of holes, from 2");
  const rim::Harmonics waves{1};
  refused(
      [&](auto& a) {  // without the matrices that go with it: names are checked first
        a.contact.assign(2, {"a", waves, 1, 0.2, 1});
        a.waves.assign(2, {"a", waves, 0.2, 1, 1});
        for (auto& level : a.cases) {
          level.W = Eigen::MatrixXd::Zero(12, a.n_cases());
          level.N = level.V = Eigen::MatrixXd::Zero(level.N.rows(), a.n_cases());
        }
        a.probe.wave = a.probe.moment = a.probe.friction_moment = Eigen::VectorXd::Zero(12);
      },
      "pressure/hole: has \"a\" at 1, expected holes of hole/id, in its order");
}

TEST_F(EditedPlate, ElementsAndArcsOfTheMesh) {
  refused([](auto& a) { a.mesh.quads(1, 0) = a.mesh.quads(0, 0); }, "mesh/quads: element 0 has the nodes ");
  refused(
      [](auto& a) {
        a.mesh.nodes.conservativeResize(2, a.mesh.n_nodes() + 1);
        a.mesh.nodes.rightCols(1).setConstant(9);
      },
      "mesh/quads: no element has node ");
  refused([](auto& a) { a.mesh.arcs[0].b = a.mesh.arcs[0].a; }, "mesh/arc_nodes: holds ");
}

/// What a field needs beyond that: functions inside elements are free.
TEST_F(EditedPlate, UnknownsThatDoNotFitTheMesh) {
  const auto refused_by_solver = [&](const std::function<void(PlateSolution&)>& edit, const std::string& message) {
    PlateSolution plate = good_;
    edit(plate);
    EXPECT_THAT([&] { stage2::FieldSolver(plate, "plate.h5"); }, ThrowsMessage<FileError>(HasSubstr(message)));
  };
  refused_by_solver([](auto& a) { a.ndof[0] += 1; }, "plate.h5:ndof: holds ");
  refused_by_solver(
      [](auto& a) {  // a function inside an element is held, and all the rest fits
        int n = 0;
        a.unknown(0, a.unknown.cols() - 1) = -1;
        for (int& dof : a.unknown.reshaped())
          if (dof >= 0) dof = n++;
        a.ndof[1] = n;
      },
      "plate.h5:unknown: holds -1 in row ");
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

}  // namespace
}  // namespace fastjoint
