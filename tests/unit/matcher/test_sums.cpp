#include "tests/catch.h"

#include "matcher/host/sum_results.h"
#include "matcher/host/winner.h"
#include "matcher/kernel.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

using namespace hsgm::matcher;
using namespace hsgm::matcher::host;

namespace {

// Rows of pixels by disparity, stored as the matcher stores sums: even indices first.
struct Rows {
    Rows(int pixels, int searched)
        : cols(pixels), count(searched), stride(padded_count(searched)),
          planes(std::size_t(pixels * stride), std::uint16_t{2040})
    {
    }
    void put(int col, int index, int sum)
    {
        const int plane = index % 2 != 0 ? stride / 2 : 0;
        planes[std::size_t(col * stride + plane + index / 2)] = static_cast<std::uint16_t>(sum);
    }
    SumsRow row() const { return {planes.data(), cols, stride, count}; }

    int cols;
    int count;
    int stride;
    std::vector<std::uint16_t> planes;
};

} // namespace

TEST_CASE("fractions and confidences in vectors are those of whole-number division")
{
    // Winner 1 of three disparities, and a fourth far enough to be the rival.
    std::mt19937 random(7);
    const auto any = [&](int most) { return int(random() % unsigned(most + 1)); };
    std::vector<std::int32_t> found(64);
    std::vector<std::uint8_t> confidence(64);
    Buffer<float> workspace;
    for (int round = 0; round < 3000; ++round) {
        Rows rows(61, 4);
        std::vector<Winner> winners(61);
        for (int col = 0; col < 61; ++col) {
            const int least = any(round % 3 == 0 ? 60000 : 300);
            const int more = any(65534 - least);
            // Quotients that just miss a whole number are where floats could go wrong.
            const int less = more * any(256) / 256 - (more > 0 ? any(1) : 0);
            const bool left = any(1) == 0;
            rows.put(col, 0, least + std::max(left ? less : more, 0));
            rows.put(col, 1, least);
            rows.put(col, 2, least + std::max(left ? more : less, 0));
            const int rival = least + any(65534 - least);
            rows.put(col, 3, rival);
            winners[std::size_t(col)] = {1, least, col % 7 == 0 ? -1 : rival};
        }
        sum_results(rows.row(), winners.data(), -20, workspace, found.data(),
                    confidence.data());
        for (int col = 0; col < 61; ++col) {
            const std::uint16_t* s = rows.row().at(col);
            const Winner& w = winners[std::size_t(col)];
            REQUIRE(found[std::size_t(col)] == subpixel_q8(-19, s[0], w.sum, s[1]));
            REQUIRE(confidence[std::size_t(col)] ==
                    (w.rival < 0 ? 255 : confidence_of(w.sum, w.rival)));
        }
    }
}

TEST_CASE("a row's winners and right candidates are those of a search in order")
{
    std::mt19937 random(11);
    for (const int count : {1, 2, 3, 16, 17, 48, 64, 96, 130, 257, 320}) {
        // Few different sums, so that ties abound; odd and even lengths of a row.
        for (const int cols : {1, 2, 37, 64}) {
            Rows rows(cols, count);
            std::vector<std::uint8_t> valid(static_cast<std::size_t>(cols), 1);
            std::vector<std::vector<int>> sums;
            sums.resize(static_cast<std::size_t>(cols));
            for (auto& pixel : sums) {
                pixel.resize(static_cast<std::size_t>(count));
            }
            for (int col = 0; col < cols; ++col) {
                valid[std::size_t(col)] = random() % 8 != 0;
                for (int i = 0; i < count; ++i) {
                    sums[std::size_t(col)][std::size_t(i)] = int(random() % 40);
                    rows.put(col, i, sums[std::size_t(col)][std::size_t(i)]);
                }
            }
            std::vector<Winner> winners(static_cast<std::size_t>(cols));
            find_winners(rows.row(), winners.data());
            RightCandidates right;
            right.clear(cols, rows.stride);
            right.merge(rows.row(), valid.data());
            std::vector<int> least(static_cast<std::size_t>(cols + count), 0xFFFF);
            std::vector<int> whose(static_cast<std::size_t>(cols + count),
                                   RightCandidates::kNobody);
            for (int col = 0; col < cols; ++col) {
                const auto& s = sums[std::size_t(col)];
                const auto best = std::min_element(s.begin(), s.end());
                const auto at = int(best - s.begin());
                int rival = -1;
                for (int i = 0; i < count; ++i) {
                    if (std::abs(i - at) >= 2 && (rival < 0 || s[std::size_t(i)] < rival)) {
                        rival = s[std::size_t(i)];
                    }
                    const auto number = std::size_t(cols - 1 - col + i);
                    if (valid[std::size_t(col)] != 0 && s[std::size_t(i)] < least[number]) {
                        least[number] = s[std::size_t(i)];
                        whose[number] = col;
                    }
                }
                const Winner& found = winners[std::size_t(col)];
                REQUIRE(found.index == at);
                REQUIRE(found.sum == *best);
                REQUIRE(found.rival == rival);
            }
            // Keys lie backwards, and some are low already.
            const int met = cols + count - 1;
            const int begin = met > 2 ? count % 3 : 0;
            std::vector<std::uint32_t> keys(std::size_t(met), 0xFFFFFFFF);
            for (std::size_t i = 0; i < keys.size(); i += 5) {
                keys[i] = 20U << 16;
            }
            auto wanted = keys;
            right.lower_keys(begin, met, 7, keys.data() + (met - 1 - begin));
            for (int number = begin; number < met; ++number) {
                const int pixel = whose[std::size_t(number)];
                auto& key = wanted[std::size_t(met - 1 - number)];
                if (pixel != RightCandidates::kNobody) {
                    key = std::min(key, std::uint32_t(least[std::size_t(number)]) << 16 |
                                            std::uint32_t(number + 7 + pixel));
                }
            }
            REQUIRE(keys == wanted);
        }
    }
}
