// Raw pairs that deceive: RPCs of other images, views from opposite sides, clouds and stripes
// that match anywhere.

#include "tests/end_to_end/raw_place.h"

#include <gdal_priv.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <memory>

using namespace hsgm;
using namespace hsgm::tests;

namespace {

using Paint = std::function<double(double pixel, int row, int col)>;

/// Changes the pixels of a copy of an image, which keeps its RPC.
void paint(const std::string& from, const std::string& to, const Paint& change)
{
    std::filesystem::copy_file(from, to);
    GDALAllRegister();
    const std::unique_ptr<GDALDataset> file(GDALDataset::Open(to.c_str(), GDAL_OF_UPDATE));
    REQUIRE(file);
    const tiling::Size size{file->GetRasterYSize(), file->GetRasterXSize()};
    std::vector<double> pixels(static_cast<std::size_t>(size.area()));
    const auto pass = [&](GDALRWFlag way) {
        REQUIRE(file->GetRasterBand(1)->RasterIO(way, 0, 0, size.cols, size.rows, pixels.data(),
                                                 size.cols, size.rows, GDT_Float64, 0,
                                                 0) == CE_None);
    };
    pass(GF_Read);
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            double& pixel = pixels[static_cast<std::size_t>(row * size.cols + col)];
            pixel = std::clamp(change(pixel, row, col), 1.0, 2040.0);
        }
    }
    pass(GF_Write);
}

struct Puff {
    double row, col, radius;
};

/// Lumpy bright discs with soft rims; `phase` makes them other ones.
Paint clouds(std::vector<Puff> puffs, double phase)
{
    return [puffs, phase](double pixel, int row, int col) {
        for (const Puff& puff : puffs) {
            const double far = std::hypot(row - puff.row, col - puff.col) / puff.radius;
            const double cover = std::clamp(1.6 - far, 0.0, 1.0);
            const double lumps = 80 * std::sin(col / 5.0 + phase * puff.row) +
                                 60 * std::cos(row / 7.0 + phase * puff.col);
            pixel = (1 - cover) * pixel + cover * (1900 + lumps);
        }
        return pixel;
    };
}

/// What a run found out about the heights.
json geometry_of(const RawPlace& place, const std::string& result)
{
    return json::parse(std::ifstream(place / (result + "/geometry.json")));
}

void check_span(const json& geometry, double low_m, double high_m)
{
    CAPTURE(geometry["heights_m"].dump());
    CHECK(geometry["heights_m"][0] > low_m);
    CHECK(geometry["heights_m"][0] < 320);
    CHECK(geometry["heights_m"][1] > 340);
    CHECK(geometry["heights_m"][1] < high_m);
}

} // namespace

TEST_CASE("the RPC of another image is told from the images")
{
    const RawPlace place;
    const auto rpc_of = [&](const std::string& name, const std::string& west) {
        hsgm_does({"synth", place / "scene.yaml", "-o", place / name, "--set",
                   "cameras.west=" + west});
        const Outcome made =
            run_program({"gdal_translate", "-q", "-co", "RPCTXT=YES",
                         place / (name + "/right.tif"), place / (name + ".tif")});
        REQUIRE(made.code == 0);
        return "pair.right={path: scene/right.tif, rpc: " + name + "_RPC.TXT}";
    };
    says(place.run("r", {"--set", rpc_of("far", "503000")}), 3,
         "the images do not overlap: at ");
    says(place.run("r", {"--set", rpc_of("near", "500100")}), 3,
         "is it the same place in both images?");
    CHECK_FALSE(std::filesystem::exists(place / "r"));
}

TEST_CASE("images from nearly opposite sides are refused")
{
    const RawPlace place;
    hsgm_does({"synth", place / "scene.yaml", "-o", place / "opposite", "--set",
               "cameras.left.toward_east=1", "--set", "cameras.right.toward_east=-1", "--set",
               "cameras.left.toward_north=0.5", "--set", "cameras.right.toward_north=-0.5"});
    const Outcome outcome =
        place.run("r", {"--set", "pair.left=" + place / "opposite/left.tif", "--set",
                        "pair.right=" + place / "opposite/right.tif"});
    says(outcome, 3, "nearly opposite sides");
    says(outcome, 3, "2.236068, at most 2 can be matched");
}

TEST_CASE("clouds and stripes that match anywhere do not widen the search for ground")
{
    const RawPlace place;
    paint(place / "scene/left.tif", place / "left.tif",
          clouds({{90, 120, 60}, {130, 340, 45}, {380, 160, 60}, {200, 60, 40}, {20, 300, 50}},
                 1));
    paint(place / "scene/right.tif", place / "right.tif",
          clouds({{300, 100, 60}, {60, 260, 55}, {250, 350, 60}, {400, 300, 45}, {150, 30, 40}},
                 2));
    const Outcome clouded =
        place.run("clouded", {"--set", "pair.left=left.tif", "--set", "pair.right=right.tif"});
    INFO(clouded.err);
    REQUIRE(clouded.code == 0);
    // The ground is at 310 to 350 m; towers of 100 m could have stood there unseen.
    check_span(geometry_of(place, "clouded"), 230, 470);

    const Paint stripes = [](double pixel, int row, int col) {
        const bool inside = row > 80 && row < 300 && col > 80 && col < 320;
        return inside ? 900 + 500 * (col / 6 % 2) + (row * 7 + col * 13) % 17 : pixel;
    };
    paint(place / "scene/left.tif", place / "left-stripes.tif", stripes);
    paint(place / "scene/right.tif", place / "right-stripes.tif", stripes);
    const Outcome striped = place.run("striped", {"--set", "pair.left=left-stripes.tif",
                                                  "--set", "pair.right=right-stripes.tif"});
    INFO(striped.err);
    REQUIRE(striped.code == 0);
    check_span(geometry_of(place, "striped"), 230, 470);
}
