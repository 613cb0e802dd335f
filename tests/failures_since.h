// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

namespace arris {

/// Whether the running test has failed since this object was made. A test of many cases has one for each, so
/// that a case that fails ends, and later cases show figures of their own.
class FailuresSince {
  public:
    bool any() const { return count() > before_; }

  private:
    static int count()
    {
        const testing::TestResult& result = *testing::UnitTest::GetInstance()->current_test_info()->result();
        int failed = 0;
        for (int k = 0; k < result.total_part_count(); ++k) failed += result.GetTestPartResult(k).failed();
        return failed;
    }

    int before_ = count();
};

}  // namespace arris
