#include "pipeline/batch/ortho_archive.h"

#include "io/error.h"
#include "pipeline/batch/csv.h"
#include "pipeline/stages/sensor_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>

namespace hsgm::pipeline {

namespace {

namespace fs = std::filesystem;
using geometry::MapBox;

constexpr double kLeastShared = 0.2;
constexpr double kLeastRatio = 0.05;
constexpr double kMostRatio = 1.2;
constexpr double kGoodFrom = 0.15;
constexpr double kGoodTo = 0.6;

using Cells = std::map<std::string, std::string>; // column -> cell

/// What is known of an image before it is paired.
struct Candidate {
    fs::path path;
    Cells view;                 ///< its row of views.csv
    MapBox box;                 ///< degrees
    geometry::ImagePoint slope; ///< metres to the east and north per metre up
    tiling::Size size;
};

/// How well two images serve as a pair.
struct Match {
    double shared = 0; ///< of the smaller one
    double ratio = 0;  ///< base to height
    bool usable() const
    {
        return shared >= kLeastShared && ratio >= kLeastRatio && ratio <= kMostRatio;
    }
    double score() const
    {
        return shared * std::min(1.0, ratio / kGoodFrom) * std::min(1.0, kGoodTo / ratio);
    }
};

double number(const std::string& text, const std::string& where)
{
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || at != end) {
        throw io::ConfigError(fmt::format("{} is '{}'; it must be a number", where, text));
    }
    return value;
}

std::map<std::string, Cells> read_views(const fs::path& folder)
{
    const fs::path path = folder / "views.csv";
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        return {};
    }
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto rows = parse_csv(text, path.string());
    std::map<std::string, Cells> views;
    const std::set<std::string> known{"image", "azimuth_deg", "incidence_deg", "rpc"};
    for (std::size_t r = 0; r < rows.size(); ++r) {
        Cells cells;
        for (std::size_t c = 0; c < rows[r].size() && c < rows[0].size(); ++c) {
            if (!known.contains(rows[0][c])) {
                throw io::ConfigError(
                    fmt::format("{}: there is no column '{}'; known are image, "
                                "azimuth_deg, incidence_deg and rpc",
                                path.string(), rows[0][c]));
            }
            if (r > 0 && !rows[r][c].empty()) {
                cells[rows[0][c]] = rows[r][c];
            }
        }
        if (r == 0) {
            continue;
        }
        if (!cells.contains("image") || !fs::exists(folder / cells["image"])) {
            throw io::ConfigError(
                fmt::format("{}: row {} names no image of the folder{}", path.string(), r + 1,
                            cells.contains("image") ? ": there is no " + cells["image"] : ""));
        }
        if (cells.contains("azimuth_deg") != cells.contains("incidence_deg")) {
            throw io::ConfigError(
                fmt::format("{}: row {} must have azimuth_deg and incidence_deg, or neither",
                            path.string(), r + 1));
        }
        if (cells.contains("rpc")) {
            cells["rpc"] = fs::absolute(folder / cells["rpc"]).lexically_normal().string();
        }
        views[cells["image"]] = cells;
    }
    return views;
}

io::ImageSpec spec_of(const Candidate& image)
{
    io::ImageSpec spec{image.path.string()};
    const auto has = [&](const char* key) { return image.view.contains(key); };
    if (has("azimuth_deg")) {
        const std::string where = "views.csv: azimuth or incidence of " + spec.path;
        spec.view_deg = {number(image.view.at("azimuth_deg"), where),
                         number(image.view.at("incidence_deg"), where)};
    }
    if (has("rpc")) {
        spec.rpc = image.view.at("rpc");
    }
    return spec;
}

/// Fills in where it lies and how it was taken; throws InputError or ConfigError where that
/// cannot be told.
void look_at(Candidate& image, double plane_m)
{
    const io::ImageSpec spec = spec_of(image);
    const io::RasterSource source(spec);
    const geometry::OrthoModel model = open_ortho(source, spec, {plane_m, nullptr});
    image.size = model.size;
    image.box = lonlat_box(model);
    const auto map = geometry::MapProjection::automatic(
        (image.box.west + image.box.east) / 2, (image.box.south + image.box.north) / 2);
    const geometry::OrthoGroundCamera camera(model, {}, map);
    constexpr double kRiseM = 100;
    const geometry::ImagePoint middle{model.size.cols / 2.0, model.size.rows / 2.0};
    const auto low = camera.locate(middle, plane_m);
    const auto high = camera.locate(middle, plane_m + kRiseM);
    if (!low || !high) {
        throw io::InputError(fmt::format("the RPC of {} does not reach it", spec.path));
    }
    image.slope = {(high->x - low->x) / kRiseM, (high->y - low->y) / kRiseM};
}

Match match_of(const Candidate& a, const Candidate& b)
{
    const double width = std::min(a.box.east, b.box.east) - std::max(a.box.west, b.box.west);
    const double height =
        std::min(a.box.north, b.box.north) - std::max(a.box.south, b.box.south);
    const double smaller =
        std::min(a.box.width() * a.box.height(), b.box.width() * b.box.height());
    Match match;
    match.shared = width > 0 && height > 0 ? width * height / smaller : 0;
    match.ratio = std::hypot(a.slope.x - b.slope.x, a.slope.y - b.slope.y);
    return match;
}

std::string why_alone(const std::vector<Candidate>& images, std::size_t i)
{
    std::size_t best = i;
    Match most;
    for (std::size_t k = 0; k < images.size(); ++k) {
        const Match match = match_of(images[i], images[k]);
        if (k != i && (best == i || match.shared > most.shared)) {
            best = k;
            most = match;
        }
    }
    if (best == i || most.shared == 0) {
        return "overlaps no other image";
    }
    const std::string other = images[best].path.filename().string();
    if (most.shared < kLeastShared) {
        return fmt::format("shares at most {:.1f} % with another image ({}), at least {:.0f} % "
                           "are needed",
                           100 * most.shared, other, 100 * kLeastShared);
    }
    return fmt::format("was taken from nearly the same place as, or nearly opposite to, each "
                       "image that it overlaps: {} at base-to-height {:.3f}, {} to {} can be "
                       "matched",
                       other, most.ratio, kLeastRatio, kMostRatio);
}

BatchPair pair_of(const Candidate& left, const Candidate& right)
{
    BatchPair pair;
    pair.name = left.path.stem().string() + "-" + right.path.stem().string();
    pair.left = fs::absolute(left.path).string();
    pair.right = fs::absolute(right.path).string();
    for (const auto& [side, image] : {std::pair("left", &left), {"right", &right}}) {
        for (const auto& [key, value] : image->view) {
            if (key != "image") {
                pair.overrides.emplace_back(fmt::format("pair.{}.{}", side, key), value);
            }
        }
    }
    return pair;
}

bool may_be_image(const fs::directory_entry& entry)
{
    static const std::set<std::string> kOthers{".xml", ".ovr", ".csv",  ".yaml", ".yml",
                                               ".txt", ".rpb", ".geom", ".imd",  ".json",
                                               ".md",  ".prj", ".tfw",  ".msk"};
    std::string ending = entry.path().extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return entry.is_regular_file() && !kOthers.contains(ending) &&
           !entry.path().filename().string().starts_with('.');
}

} // namespace

OrthoArchive pair_orthos(const fs::path& folder, double plane_m)
{
    const auto views = read_views(folder);
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (may_be_image(entry)) {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    OrthoArchive archive;
    std::vector<Candidate> images;
    for (const fs::path& file : files) {
        const auto view = views.find(file.filename().string());
        Candidate image{file, view == views.end() ? Cells{} : view->second, {}, {}, {}};
        try {
            look_at(image, plane_m);
            images.push_back(std::move(image));
        } catch (const io::InputError& error) {
            archive.left_out.push_back({file.string(), error.what()});
        }
    }
    std::set<std::pair<std::size_t, std::size_t>> chosen;
    for (std::size_t i = 0; i < images.size(); ++i) {
        std::optional<std::size_t> best;
        for (std::size_t k = 0; k < images.size(); ++k) {
            const Match match = match_of(images[i], images[k]);
            if (k != i && match.usable() &&
                (!best || match.score() > match_of(images[i], images[*best]).score())) {
                best = k;
            }
        }
        if (best) {
            chosen.insert(std::minmax(i, *best));
        } else {
            archive.left_out.push_back({images[i].path.string(), why_alone(images, i)});
        }
    }
    for (const auto& [left, right] : chosen) {
        archive.pairs.push_back(pair_of(images[left], images[right]));
    }
    return archive;
}

std::string text_of(const std::vector<LeftOutImage>& left_out)
{
    std::string text = csv_row({"image", "why"});
    for (const LeftOutImage& image : left_out) {
        text += csv_row({image.image, image.why});
    }
    return text;
}

} // namespace hsgm::pipeline
