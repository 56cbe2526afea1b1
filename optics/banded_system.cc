// SPDX-License-Identifier: Apache-2.0
#include "optics/banded_system.h"

#include <algorithm>

#include "base/check.h"

namespace lorgnette {

BandedSystem::BandedSystem(int size, int band) : lower_(Eigen::MatrixXd::Zero(band + 1, size)) {}

std::optional<Eigen::VectorXd> BandedSystem::SolveInPlace(Eigen::VectorXd right) {
  const int n = size(), band = int(lower_.rows()) - 1;
  LG_CHECK_EQ(int(right.size()), n);
  // Column by column: each loses what the earlier ones explain of it, four of them at a time.
  for (int j = 0; j < n; ++j) {
    const int below = std::min(band, n - 1 - j);
    auto column = lower_.col(j).head(below + 1);
    int k = std::max(0, j - band);
    const auto share = [&](int i) { return lower_(j - i, i) * lower_(0, i); };
    for (; k + 4 <= j; k += 4) {
      // Of the first of the four the fewest entries reach this column.
      const int reach = std::min(band - (j - k), below) + 1;
      const double a = share(k), b = share(k + 1), c = share(k + 2), d = share(k + 3);
      column.head(reach) -= a * lower_.col(k).segment(j - k, reach) +
                            b * lower_.col(k + 1).segment(j - k - 1, reach) +
                            c * lower_.col(k + 2).segment(j - k - 2, reach) +
                            d * lower_.col(k + 3).segment(j - k - 3, reach);
      for (int i = 1; i < 4; ++i) {
        const int more = std::min(band - (j - k) + i, below) + 1 - reach;
        column.segment(reach, more) -=
            share(k + i) * lower_.col(k + i).segment(j - k - i + reach, more);
      }
    }
    for (; k < j; ++k) {
      const int reach = std::min(band - (j - k), below) + 1;
      column.head(reach) -= share(k) * lower_.col(k).segment(j - k, reach);
    }
    const double pivot = column(0);
    if (!(pivot > 0)) return std::nullopt;
    column.tail(below) /= pivot;
    right.segment(j + 1, below) -= right(j) * column.tail(below);
  }
  for (int j = n - 1; j >= 0; --j) {
    const int below = std::min(band, n - 1 - j);
    right(j) =
        right(j) / lower_(0, j) - lower_.col(j).segment(1, below).dot(right.segment(j + 1, below));
  }
  return right;
}

}  // namespace lorgnette
