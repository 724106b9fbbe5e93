#include "tests/catch.h"

#include "pipeline/stages/pixel_checksum.h"

#include <cstring>
#include <limits>
#include <string>
#include <vector>

using namespace hsgm;
using namespace hsgm::pipeline;

namespace {

// Seven rows of five pixels, read so many rows at a time.
class Rows final : public PixelSource {
public:
    explicit Rows(int rows_at_a_time) : rows_at_a_time_(rows_at_a_time), image_({7, 5})
    {
        for (int i = 0; i < 35; ++i) {
            image_.data()[i] = i * i;
        }
    }
    double& at(int row, int col) { return image_(row, col); }

    tiling::Size size() const override { return image_.size(); }
    io::PixelType pixel_type() const override { return io::PixelType::float32; }
    std::string description() const override { return "rows"; }
    std::vector<tiling::Rect> reading_windows() const override
    {
        std::vector<tiling::Rect> windows;
        for (int row = 0; row < 7; row += rows_at_a_time_) {
            windows.push_back({row, 0, std::min(rows_at_a_time_, 7 - row), 5});
        }
        return windows;
    }
    void read(const tiling::Rect& window, tiling::ImageView<double> values) override
    {
        for (int r = 0; r < window.rows; ++r) {
            for (int c = 0; c < window.cols; ++c) {
                values(r, c) = image_(window.row + r, window.col + c);
            }
        }
    }

private:
    int rows_at_a_time_;
    tiling::Image<double> image_;
};

std::string checksum(Rows rows)
{
    return checksum_of(rows);
}

} // namespace

TEST_CASE("the checksum of pixels does not depend on how many rows are read at a time")
{
    const std::string whole = checksum(Rows(7));
    CHECK(whole.size() == 16);
    for (const int rows : {1, 2, 3, 5}) {
        CHECK(checksum(Rows(rows)) == whole);
    }
}

TEST_CASE("every pixel takes part in the checksum, and so does its place")
{
    const std::string before = checksum(Rows(3));
    for (int row = 0; row < 7; ++row) {
        for (int col = 0; col < 5; ++col) {
            Rows rows(3);
            rows.at(row, col) += 1;
            CHECK(checksum(rows) != before);
        }
    }
    Rows swapped(3);
    std::swap(swapped.at(2, 1), swapped.at(4, 1));
    CHECK(checksum(swapped) != before);
}

TEST_CASE("a pixel without a value is the same whatever its bits, and unlike any value")
{
    Rows one(2);
    one.at(3, 3) = std::numeric_limits<double>::quiet_NaN();
    Rows other(4);
    const std::uint64_t bits = 0xFFF8000000001234ULL; // a NaN as well
    std::memcpy(&other.at(3, 3), &bits, sizeof bits);
    CHECK(checksum(one) == checksum(other));
    CHECK(checksum(one) != checksum(Rows(2)));
}
