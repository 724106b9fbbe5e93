#include "matcher/host/lookup.h"

#include <algorithm>

namespace hsgm::matcher::host {

void lookup_costs(const HmiTable& table, const CostRow& row, std::uint8_t* costs)
{
    for (int i = 0; i < row.cols; ++i, costs += row.stride) {
        const int first = row.cols - 1 - i;
        for (int j = 0; j < row.count; ++j) {
            costs[j] = row.left_valid[i] != 0 && row.right_valid[first + j] != 0
                           ? table(row.left[i], row.right[first + j])
                           : row.half;
        }
        std::fill(costs + row.count, costs + row.stride, std::uint8_t{255});
    }
}

} // namespace hsgm::matcher::host
