// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gsl/gsl_errno.h>

#include <cstdlib>
#include <string>
#include <string_view>

/// OpenBLAS calls this for an argument that it refuses, as that of an empty matrix; its own would print and go on.
extern "C" int xerbla_(const char* name, int* argument, int length) {
  ADD_FAILURE() << "argument " << *argument << " of " << std::string_view(name, length) << " is refused";
  return 0;
}

/// Filter of every n-th suite from the k-th on, without long ones (*Sweep). Whole suites, since their tests share what
/// one of them has solved; GoogleTest's own shards take them apart.
std::string filter_of_part(int k, int n) {
  std::string filter;
  const auto& all = *testing::UnitTest::GetInstance();
  for (int i = k; i < all.total_test_suite_count(); i += n) filter += std::string(all.GetTestSuite(i)->name()) + ".*:";
  return filter + "-*Sweep.*";
}

/// Runs the tests as any program of GoogleTest does; "part K N" in place of a filter chooses suites.
int main(int argc, char** argv) {
  gsl_set_error_handler_off();
  testing::InitGoogleMock(&argc, argv);
  if (argc == 4 && argv[1] == std::string_view("part"))
    testing::GTEST_FLAG(filter) = filter_of_part(std::atoi(argv[2]), std::atoi(argv[3]));
  return RUN_ALL_TESTS();
}
