// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gsl/gsl_errno.h>

#include <string_view>

/// OpenBLAS calls this for an argument that it refuses, as that of an empty matrix; its own would print and go on.
extern "C" int xerbla_(const char* name, int* argument, int length) {
  ADD_FAILURE() << "argument " << *argument << " of " << std::string_view(name, length) << " is refused";
  return 0;
}

int main(int argc, char** argv) {
  gsl_set_error_handler_off();
  testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
