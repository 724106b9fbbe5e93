#pragma once

#include "tiling/image.h"
#include "tiling/rect.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>

namespace hsgm::io {

/// How long a scratch file lives.
enum class ScratchLife {
    temporary, ///< made anew, removed when destroyed
    kept,      ///< made anew, stays for a later process
    existing,  ///< kept by an earlier process; stays
};

/// A file of fixed length whose room is reserved when it is made. Reads and writes may run
/// side by side where their ranges do not meet.
class ScratchFile {
public:
    /// Makes a new file of copies of `fill` (its length divides `bytes`), or opens an existing
    /// one of that length. Throws StorageError: where room is missing, saying how many bytes
    /// are needed and how many are free.
    ScratchFile(const std::filesystem::path& path, std::int64_t bytes,
                std::span<const std::byte> fill, ScratchLife life = ScratchLife::temporary);
    ~ScratchFile();
    ScratchFile(ScratchFile&& other) noexcept;
    ScratchFile& operator=(ScratchFile&&) = delete;

    /// Both throw StorageError with path and the system's message.
    void read(std::int64_t offset, std::byte* data, std::size_t bytes) const;
    void write(std::int64_t offset, const std::byte* data, std::size_t bytes);
    /// Returns when everything written so far is on the disk. Throws StorageError.
    void sync();

    const std::filesystem::path& path() const { return path_; }

private:
    void open_existing(std::int64_t bytes);
    void make(std::int64_t bytes, std::span<const std::byte> fill);
    void reserve(std::int64_t bytes);
    void fill_with(std::span<const std::byte> fill, std::int64_t bytes);
    void remove() noexcept;
    [[noreturn]] void fail(const std::string& what, int code) const;

    std::filesystem::path path_;
    bool keep_;
    int fd_ = -1;
};

/// Intermediate pixels that may not fit in memory: rows x cols of T in a raw file, row by
/// row. The disk is checked once, when it is made, so a run does not die half way of a full
/// one. Threads may use one raster together where their rectangles are disjoint.
template <typename T>
class ScratchRaster {
    static_assert(std::is_trivially_copyable_v<T>, "pixels are stored as their bytes");

public:
    /// Every pixel of a new one starts as `fill`. Throws StorageError where the room is
    /// missing, or an existing one is not there in full length.
    ScratchRaster(const std::filesystem::path& folder, const std::string& name,
                  tiling::Size size, T fill = T{}, ScratchLife life = ScratchLife::temporary)
        : size_(size), file_(folder / name, size.area() * static_cast<std::int64_t>(sizeof(T)),
                             std::as_bytes(std::span<const T>(&fill, 1)), life)
    {
    }

    tiling::Size size() const { return size_; }
    const std::filesystem::path& path() const { return file_.path(); }

    /// Reads `rect`, which lies inside the raster, into a view of its size.
    void read(const tiling::Rect& rect, tiling::ImageView<T> pixels) const
    {
        for_runs(rect, pixels, [&](std::int64_t offset, T* run, std::size_t bytes) {
            file_.read(offset, reinterpret_cast<std::byte*>(run), bytes);
        });
    }

    /// Writes a view to `rect`, which lies inside the raster and has the view's size.
    void write(const tiling::Rect& rect, tiling::ImageView<const T> pixels)
    {
        for_runs(rect, pixels, [&](std::int64_t offset, const T* run, std::size_t bytes) {
            file_.write(offset, reinterpret_cast<const std::byte*>(run), bytes);
        });
    }

    /// Returns when everything written so far is on the disk. Throws StorageError.
    void sync() { file_.sync(); }

private:
    /// One run per row, or one in all where rows follow each other both in file and memory.
    template <typename View, typename Transfer>
    void for_runs(const tiling::Rect& rect, View pixels, Transfer transfer) const
    {
        assert(tiling::rect_of(size_).contains(rect) && pixels.size() == rect.size());
        if (rect.empty()) {
            return;
        }
        const bool joined = rect.cols == size_.cols && pixels.stride() == rect.cols;
        const std::int64_t run = joined ? rect.area() : rect.cols;
        for (int r = 0; r < (joined ? 1 : rect.rows); ++r) {
            const std::int64_t first = std::int64_t{rect.row + r} * size_.cols + rect.col;
            transfer(first * static_cast<std::int64_t>(sizeof(T)), pixels.row(r),
                     static_cast<std::size_t>(run) * sizeof(T));
        }
    }

    tiling::Size size_;
    ScratchFile file_;
};

} // namespace hsgm::io
