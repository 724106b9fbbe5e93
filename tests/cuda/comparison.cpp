#include "tests/cuda/comparison.h"

#include <sstream>

namespace hsgm::cuda_test {

namespace {

using tiling::Rect;

template <typename T>
tiling::Patch<T> cut(const tiling::Image<T>& image, const Rect& rect)
{
    tiling::Patch<T> patch(rect);
    for (int row = rect.row; row < rect.row_end(); ++row) {
        for (int col = rect.col; col < rect.col_end(); ++col) {
            patch.at(row, col) = image(row, col);
        }
    }
    return patch;
}

template <typename T>
std::string first_difference(const char* what, const tiling::Image<T>& host,
                             const tiling::Image<T>& device)
{
    std::ostringstream text;
    int count = 0;
    if (host.size() != device.size()) {
        return std::string(what) + ": sizes differ";
    }
    for (int row = 0; row < host.rows(); ++row) {
        for (int col = 0; col < host.cols(); ++col) {
            if (host(row, col) != device(row, col) && count++ == 0) {
                text << what << " at row " << row << ", col " << col << " of the tile: host "
                     << +host(row, col) << ", device " << +device(row, col);
            }
        }
    }
    if (count > 0) {
        text << " (" << count << " of " << host.size().area() << " differ)";
    }
    return text.str();
}

} // namespace

Pair::Pair(const reference::Case& c)
    : matcher_(reference::traits_of(c), c.options),
      left_(reference::pyramid(c.pair.left, matcher_.plan().levels())),
      right_(reference::pyramid(c.pair.right, matcher_.plan().levels())),
      coarse_(matcher_.solve_coarse(left_.back(), right_.back()))
{
}

std::vector<matcher::LevelImages> Pair::images(const Rect& core) const
{
    const auto support = matcher_.support(core);
    std::vector<matcher::LevelImages> images;
    for (int level = 0; level < matcher_.plan().windowed_levels(); ++level) {
        const auto k = static_cast<std::size_t>(level);
        images.push_back(
            {cut(left_[k], support[k].left_image), cut(right_[k], support[k].right_image)});
    }
    return images;
}

matcher::cuda::DeviceInfo device_of(const Setting& setting)
{
    stand_in::DeviceTraits traits;
    traits.shared_bytes_per_block = static_cast<std::size_t>(setting.shared_bytes);
    traits.multiprocessors = setting.multiprocessors;
    stand_in::set_device_traits(traits);
    stand_in::set_schedule(setting.schedule);
    auto device = matcher::cuda::find_devices().usable.front();
    device.block_threads = setting.block_threads;
    return device;
}

Setting setting_number(std::uint64_t number)
{
    const auto schedules = stand_in::all_schedules();
    constexpr int kThreads[] = {32, 64, 96};
    constexpr std::int64_t kKibibytes[] = {227, 163, 99, 64, 48, 32};
    Setting setting;
    setting.schedule = schedules[number % schedules.size()];
    setting.schedule.seed = number + 1;
    setting.block_threads = kThreads[number / 7 % 3];
    setting.shared_bytes = 1024 * kKibibytes[number / 21 % 6];
    setting.multiprocessors = 1 + static_cast<int>(number % 3);
    return setting;
}

std::string difference(const matcher::TileMatch& host, const matcher::TileMatch& device)
{
    for (const std::string& text :
         {first_difference("disparity", host.disparity_q8, device.disparity_q8),
          first_difference("confidence", host.confidence, device.confidence),
          first_difference("reasons", host.reasons, device.reasons),
          first_difference("right keys", host.right_keys.pixels, device.right_keys.pixels)}) {
        if (!text.empty()) {
            return text;
        }
    }
    if (!(host.right_keys.rect == device.right_keys.rect && host.core == device.core)) {
        return "the places differ";
    }
    return host.work == device.work ? "" : "the work counted differs";
}

Outcome compare_tiles(const reference::Case& c, const Setting& setting)
{
    const Pair pair(c);
    const auto device = device_of(setting);
    if (!matcher::cuda::refusal(pair.matcher(), device).empty()) {
        return {true, ""};
    }
    const auto coarse = matcher::cuda::upload_coarse(pair.matcher(), pair.coarse(), device);
    const auto on_device =
        matcher::cuda::make_device_matcher(pair.matcher(), coarse, device, c.tiles);
    for (const Rect& core : c.tiles) {
        const auto images = pair.images(core);
        const std::string found =
            difference(pair.matcher().match_tile(core, images, pair.coarse()),
                       on_device->match_tile(core, images));
        if (!found.empty()) {
            std::ostringstream text;
            text << "tile {" << core.row << ", " << core.col << ", " << core.rows << ", "
                 << core.cols << "}: " << found;
            return {false, text.str()};
        }
    }
    return {};
}

} // namespace hsgm::cuda_test
