// SPDX-License-Identifier: GPL-3.0-or-later
// PLATE.h5 files that someone has edited: what no plate can have is refused with its dataset.
#include <fmt/format.h>
#include <gmock/gmock.h>

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

 private:
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
  refused([](auto& a) { a.p << 3, 2; }, "p: is 3, 2, expected ascending degrees from 1 to 8");
  refused([](auto& a) { a.p[1] = 9; }, "p: is 2, 9, expected");
  refused([](auto& a) { a.ndof[0] = a.ndof[1] + 1; }, "ndof: is ");
  refused([](auto& a) { a.stress_p << 3, 2; }, "stress_p: is 3, 2, expected ascending degrees");
}

TEST_F(EditedPlate, RowsOfASparseMatrix) {
  refused([](auto& a) { a.K_fc.innerIndexPtr()[1] = a.K_fc.innerIndexPtr()[0]; }, "K_fc: is not a sparse matrix");
}

TEST_F(EditedPlate, RimsThatAreNotArcsOfTheirCircle) {
  refused([](auto& a) { a.hole_rim[0].sides[0].local_edge ^= 1; }, "hole/rim: the sides of hole \"a\"");
  refused([](auto& a) { a.hole_rim[0].radius = 0; }, "hole/rim: the sides of hole \"a\"");
  refused([](auto& a) { a.hole_rim[0].sides.pop_back(); }, "hole/rim: the sides of hole \"a\"");
}

TEST_F(EditedPlate, InfiniteNumbers) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  refused([](auto& a) { a.cases[1].U(0, 0) = infinite; }, "p3/U: holds an infinite number, expected finite ones");
  refused([](auto& a) { a.hole_spring[0].acts[0].to = infinite; }, "hole/arc: holds an infinite number");
}

}  // namespace
}  // namespace fastjoint
