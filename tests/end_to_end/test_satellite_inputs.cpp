// What may be said of a raw pair beside its images: regions, masks, heights, corrections.

#include "tests/end_to_end/raw_place.h"

#include <cmath>

using namespace hsgm;
using namespace hsgm::tests;

namespace {

// Of dsm::Missing, as docs/outputs.md has them.
enum Code { kNone, kOutside, kOutsideRegion, kMaskedLeft, kMaskedRight, kOccluded, kHidden };

/// A DSM with its reasons, by places on the map.
class Surface {
public:
    explicit Surface(const std::string& folder)
        : heights_(pixels_of(folder + "/dsm.tif")),
          reasons_(pixels_of(folder + "/dsm.reasons.tif"))
    {
        const json info = gdalinfo(folder + "/dsm.tif");
        west_ = info["geoTransform"][0];
        north_ = info["geoTransform"][3];
        cell_ = info["geoTransform"][1];
        REQUIRE(heights_.size() == reasons_.size());
    }
    tiling::Size size() const { return heights_.size(); }
    double west() const { return west_; }
    double north() const { return north_; }
    double east() const { return west_ + heights_.cols() * cell_; }
    double south() const { return north_ - heights_.rows() * cell_; }
    double x(int col) const { return west_ + (col + 0.5) * cell_; }
    double y(int row) const { return north_ - (row + 0.5) * cell_; }
    int reason(int row, int col) const { return static_cast<int>(reasons_(row, col)); }
    double height(int row, int col) const { return heights_(row, col); }
    int reason_at(double x, double y) const
    {
        return reason(static_cast<int>((north_ - y) / cell_),
                      static_cast<int>((x - west_) / cell_));
    }
    int count(int code) const
    {
        int n = 0;
        for (const double reason : reasons_.pixels()) {
            n += reason == code;
        }
        return n;
    }
    void has_a_value_or_a_reason_everywhere() const
    {
        int wrong = 0;
        for (std::int64_t i = 0; i < size().area(); ++i) {
            wrong += std::isnan(heights_.data()[i]) != (reasons_.data()[i] != 0);
        }
        CHECK(wrong == 0);
    }

private:
    tiling::Image<double> heights_;
    tiling::Image<double> reasons_;
    double west_ = 0;
    double north_ = 0;
    double cell_ = 1;
};

/// A square of the scene as GeoJSON in longitude and latitude.
std::string square(const std::string& corners, const std::string& crs = "")
{
    return R"({"type": "FeatureCollection", )" + crs + R"("features": [{"type": "Feature",
        "properties": {}, "geometry": {"type": "Polygon", "coordinates": [[)" +
           corners + "]]}}]}";
}

// x 500060 to 500110, y 5299880 to 5299940 of UTM zone 33 north.
constexpr const char* kSquareDeg = "[15.000802, 47.852262], [15.001470, 47.852262], "
                                   "[15.001470, 47.852802], [15.000802, 47.852802], "
                                   "[15.000802, 47.852262]";

/// A mask for an image of the scene: 0 in a rectangle, 1 elsewhere.
void write_mask(const std::string& path, const std::string& image, const tiling::Rect& masked)
{
    const tiling::Size size = pixels_of(image).size();
    std::vector<double> pixels(static_cast<std::size_t>(size.area()), 1.0);
    for (int r = masked.row; r < std::min(masked.row_end(), size.rows); ++r) {
        for (int c = masked.col; c < std::min(masked.col_end(), size.cols); ++c) {
            pixels[static_cast<std::size_t>(r * size.cols + c)] = 0;
        }
    }
    make_raster(path, GDT_Byte, size, {pixels});
}

} // namespace

TEST_CASE("a region of interest limits the work and the DSM")
{
    const RawPlace place;
    REQUIRE(place.run("all").code == 0);
    const Surface all(place / "all");
    all.has_a_value_or_a_reason_everywhere();
    CHECK(all.count(kOutsideRegion) == 0);
    CHECK(all.count(kOutside) > 100);
    CHECK(all.count(kOccluded) > 100);
    CHECK(all.count(kHidden) > 100);

    const Outcome bounded = place.run(
        "bounded", {"--set", "dsm.bounds=[500060.2, 5299880.2, 500109.9, 5299939.9]"});
    INFO(bounded.err);
    REQUIRE(bounded.code == 0);
    const Surface part(place / "bounded");
    CHECK(part.west() == 500060.0);
    CHECK(part.north() == 5299940.0);
    CHECK(part.east() == 500110.0);
    CHECK(part.south() == 5299880.0);
    part.has_a_value_or_a_reason_everywhere();
    // The same ground, found in a smaller frame.
    std::vector<double> apart;
    for (int row = 0; row < part.size().rows; ++row) {
        for (int col = 0; col < part.size().cols; ++col) {
            const int there_row = row + static_cast<int>((all.north() - part.north()) / 0.5);
            const int there_col = col + static_cast<int>((part.west() - all.west()) / 0.5);
            const double off =
                std::abs(part.height(row, col) - all.height(there_row, there_col));
            if (!std::isnan(off)) {
                apart.push_back(off);
            }
        }
    }
    REQUIRE(apart.size() > 10000);
    std::sort(apart.begin(), apart.end());
    CHECK(apart[apart.size() / 2] < 0.05);
    CHECK(apart[apart.size() * 95 / 100] < 0.3);
    CHECK(pixels_of(place / "bounded/disparity.tif").size().area() <
          pixels_of(place / "all/disparity.tif").size().area() * 2 / 3);
}

TEST_CASE("a region may be a vector file in any reference system")
{
    const RawPlace place;
    put_bytes(place / "area.geojson", square(kSquareDeg)); // GeoJSON means WGS84
    const Outcome outcome = place.run("r", {"--set", "dsm.region=area.geojson"});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const Surface part(place / "r");
    CHECK(std::abs(part.west() - 500060) < 1.1);
    CHECK(std::abs(part.north() - 5299940) < 1.1);
    CHECK(std::abs(part.east() - 500110) < 1.1);
    CHECK(std::abs(part.south() - 5299880) < 1.1);
    part.has_a_value_or_a_reason_everywhere();
    // A triangle in it, in another one: what lies beyond its long side is outside.
    put_bytes(place / "half.geojson",
              square("[500060, 5299880], [500110, 5299880], [500060, 5299940], "
                     "[500060, 5299880]",
                     R"("crs": {"type": "name", "properties": {"name": "EPSG:32633"}}, )"));
    REQUIRE(place.run("half", {"--set", "dsm.region=half.geojson"}).code == 0);
    const Surface half(place / "half");
    half.has_a_value_or_a_reason_everywhere();
    CHECK(half.reason_at(500105, 5299935) == kOutsideRegion);
    CHECK(half.reason_at(500070, 5299890) != kOutsideRegion);
    CHECK(std::abs(half.count(kOutsideRegion) / double(half.size().area()) - 0.5) < 0.02);
}

TEST_CASE("regions that cannot be are refused in one sentence")
{
    const RawPlace place;
    const auto refused = [&](const std::string& setting, int code, const std::string& part) {
        says(place.run("r", {"--set", setting}), code, part);
    };
    refused("dsm.bounds=[0, 0, 100, 100]", 3, "the region of interest, x ");
    refused("dsm.bounds=[0, 0, 100, 100]", 3, "lies outside what both images show");
    refused("dsm.bounds=[9, 0, 1, 1]", 2, "'dsm.bounds' is [9, 0, 1, 1]; it must be [west");
    refused("dsm.bounds=[1, 2, 3]", 2, "'dsm.bounds' has 3 items; it must have 4");
    refused("dsm.bounds_crs=EPSG:4326", 2, "has no meaning without bounds");
    refused("dsm.region=none.gpkg", 3, "none.gpkg");
    put_bytes(place / "empty.geojson", R"({"type": "FeatureCollection", "features": []})");
    refused("dsm.region=empty.geojson", 3, "holds no polygon, so it bounds no area");
    put_bytes(place / "nowhere.csv", "id,WKT\n1,\"POLYGON((0 0,9 0,9 9,0 0))\"\n");
    refused("dsm.region=nowhere.csv", 3, "has no coordinate reference system");
    put_bytes(place / "area.geojson", square(kSquareDeg));
    says(place.run("r", {"--set", "dsm.region=area.geojson", "--set",
                         "dsm.bounds=[500060, 5299880, 500110, 5299940]"}),
         2, "'dsm.region' and bounds both say which part is wanted");
    says(place.run("r",
                   {"--set", "dsm.bounds=[15, 47, 16, 48]", "--set", "dsm.bounds_crs=EPSG:99"}),
         2, "'dsm.bounds_crs' cannot be used");
    CHECK_FALSE(std::filesystem::exists(place / "r"));
}

TEST_CASE("masks of either image are carried through to the reasons of the DSM")
{
    const RawPlace place;
    write_mask(place / "left_mask.tif", place / "scene/left.tif", {100, 100, 60, 60});
    put_bytes(place / "clouds.geojson", square(kSquareDeg)); // on the map, through the RPC
    const Outcome outcome =
        place.run("r", {"--set", "pair.left={path: scene/left.tif, mask: left_mask.tif}",
                        "--set", "pair.right={path: scene/right.tif, mask: clouds.geojson}"});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const Surface surface(place / "r");
    surface.has_a_value_or_a_reason_everywhere();
    // Cells are as large as pixels: 60 x 60 of the left image, but for what lies under the
    // other mask.
    CHECK(surface.count(kMaskedLeft) > 2800);
    CHECK(surface.count(kMaskedLeft) < 4400);
    // 100 x 120 cells of the map. Along their rim some are taken for occluded: what the right
    // image would have shown there, it shows nowhere.
    CHECK(surface.count(kMaskedRight) > 7000);
    CHECK(surface.count(kMaskedRight) < 14000);
    CHECK(surface.reason_at(500085, 5299910) == kMaskedRight);
}

TEST_CASE("an image without a single valid pixel is refused, and mostly clouded ones tell why")
{
    const RawPlace place;
    write_mask(place / "all.tif", place / "scene/right.tif", {0, 0, 10000, 10000});
    const std::string clouded = "pair.right={path: scene/right.tif, mask: all.tif}";
    says(place.run("r", {"--set", clouded}), 3,
         "has no valid pixel: everything is nodata or masked");
    // Also where nothing is to be found from the pixels.
    says(place.run("r", {"--set", clouded, "--set", "geometry.pointing=none", "--set",
                         "geometry.heights_m=[300, 360]"}),
         3, "has no valid pixel: everything is nodata or masked");
    const int cols = pixels_of(place / "scene/right.tif").cols();
    write_mask(place / "most.tif", place / "scene/right.tif", {0, 0, 10000, cols - 30});
    const Outcome most =
        place.run("r", {"--set", "pair.right={path: scene/right.tif, mask: most.tif}"});
    says(most, 3, "tie points agree");
    says(most, 3, "% of the right image's pixels are valid");
}

TEST_CASE("given heights are taken, and wrong ones told from the images")
{
    const RawPlace place;
    const Outcome narrow = place.run("narrow", {"--set", "geometry.heights_m=[316, 323]"});
    INFO(narrow.err);
    CHECK(narrow.code == 0);
    CHECK(narrow.err.find("geometry.heights_m is [316, 323], but ") != std::string::npos);
    CHECK(narrow.err.find("what is outside will be missing or wrong") != std::string::npos);
    const Outcome wrong = place.run("r", {"--set", "geometry.heights_m=[200, 240]"});
    INFO(wrong.err);
    CHECK(wrong.code == 3);
    CHECK(wrong.err.find("; geometry.heights_m is [200, 240]: by the images the ground lies "
                         "at ") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(place / "r"));
}

TEST_CASE("corrections that one run found serve another, whichever image is the left one")
{
    const RawPlace place;
    REQUIRE(place.run("found").code == 0);
    const std::string from = "geometry.pointing_from=" + place / "found/geometry.json";
    for (const bool swapped : {false, true}) {
        std::vector<std::string> more{"--set", from, "--set", "geometry.heights_m=[310, 345]"};
        if (swapped) {
            more.insert(more.end(), {"--set", "pair.left=scene/right.tif", "--set",
                                     "pair.right=scene/left.tif"});
        }
        const std::string name = swapped ? "swapped" : "given";
        const Outcome outcome = place.run(name, more);
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        CHECK(outcome.err.find("pointing as given") != std::string::npos);
        const json score = place.score(name);
        CAPTURE(score.dump(1));
        CHECK(score["completeness_percent"] > 96);
        CHECK(score["nmad_m"] < 0.15);
        // The place is that of the first run, since nothing was found anew.
        const json first = place.score("found");
        for (const char* axis : {"east_m", "north_m", "up_m"}) {
            CHECK(std::abs(score["shift"][axis].get<double>() -
                           first["shift"][axis].get<double>()) < 0.05);
        }
    }
    says(place.run("r", {"--set", from, "--set", "geometry.pointing=shift"}), 2,
         "'geometry.pointing' is what geometry.pointing_from says already");
    says(place.run(
             "r", {"--set", from, "--set", "geometry.stored=" + place / "found/geometry.json"}),
         2, "'geometry.pointing_from' is what geometry.stored says already");
    const RawPlace other("1");
    says(other.run("r", {"--set", from}), 3, "has no corrections for ");
    says(place.run("r", {"--set", "geometry.pointing_from=run.yaml"}), 3,
         "the stored geometry cannot be read");
}
