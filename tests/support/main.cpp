// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gsl/gsl_errno.h>

#include "common/h5/library.hpp"

int main(int argc, char** argv) {
  fastjoint::h5::take_over_error_reporting();
  gsl_set_error_handler_off();
  testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
