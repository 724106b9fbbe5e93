#pragma once

#include "pipeline/job.h"
#include "tests/seam/stereo.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// Whole runs, from files to files.
namespace hsgm::seam {

/// A folder of its own for one test, removed with everything in it.
class TemporaryFolder {
public:
    explicit TemporaryFolder(
        const std::filesystem::path& parent = std::filesystem::temp_directory_path());
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

enum class Storage {
    uint8,   ///< nodata 0
    uint16,  ///< eightfold values, nodata 7
    float32, ///< fractions, nodata -1, and NaN for every other pixel without a value
};

/// Writes both images as GeoTIFFs into the folder; a job that matches them into
/// disparity.tif, confidence.tif, reasons.tif, height.tif and hillshade.png there.
pipeline::Job write_pair(const StereoPair& pair, Storage storage,
                         const std::filesystem::path& folder);

/// The same outputs for any job.
void set_outputs(pipeline::Job& job, const std::filesystem::path& folder);

/// What a run leaves behind of one raster.
struct StoredRaster {
    std::string name;
    std::string bytes;          ///< of the file
    std::vector<double> pixels; ///< decoded; nodata is a number of its own
};

/// What lies in these files.
std::vector<StoredRaster> stored_rasters(const std::vector<std::filesystem::path>& paths);

/// Plans and carries out the job, and reads its rasters; the files stay.
std::vector<StoredRaster> run(const pipeline::Job& job);

/// Empty where pixels and bytes of all rasters are the same.
std::string difference(const std::vector<StoredRaster>& a, const std::vector<StoredRaster>& b);

/// How one run is carried out.
struct Manner {
    std::optional<int> tile_size_px; ///< absent: as the budget has it
    int threads;
    tiling::TileOrder order = tiling::TileOrder::rows;
    std::optional<std::uint64_t> memory_bytes = std::nullopt;
};
std::string text(const Manner& manner);

/// Runs the job in every manner; each must give what the first one gave. The differences
/// found, one a line.
std::string differences_between(pipeline::Job job, const std::vector<Manner>& manners);

} // namespace hsgm::seam
