#include "pipeline/stages/refine_stage.h"

#include "io/geotiff_writer.h"
#include "matcher/reasons.h"
#include "pipeline/error.h"
#include "pipeline/stages/height.h"

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace hsgm::pipeline {

namespace {

using tiling::Rect;
using tiling::Size;

// Pieces are whole blocks of the outputs, in the order in which blocks lie in the file.
constexpr int kPieceRows = 256;
constexpr int kPieceCols = 2048;
constexpr std::size_t kPiecesInFlight = 4;

class Pieces {
public:
    explicit Pieces(Size image)
        : image_(image), across_(tiling::ceil_div(image.cols, kPieceCols)),
          count_(across_ * tiling::ceil_div(image.rows, kPieceRows))
    {
    }
    std::optional<Rect> next()
    {
        if (given_ == count_) {
            return std::nullopt;
        }
        const int i = given_++;
        return intersect(
            {i / across_ * kPieceRows, i % across_ * kPieceCols, kPieceRows, kPieceCols},
            rect_of(image_));
    }

private:
    Size image_;
    int across_;
    int count_;
    int given_ = 0;
};

io::RasterOptions raster_options(const Job& job, const io::GeoReference& geo,
                                 const char* description)
{
    io::RasterOptions options;
    options.geo = geo;
    options.metadata = provenance(job);
    options.band_descriptions = {description};
    options.creation_options = job.outputs.creation_options;
    return options;
}

io::RasterOptions float_options(const Job& job, const io::GeoReference& geo,
                                const char* description, const char* unit)
{
    io::RasterOptions options = raster_options(job, geo, description);
    options.nodata = matcher::kNodataDisparity;
    options.unit = unit;
    return options;
}

io::RasterOptions reason_options(const Job& job, const io::GeoReference& geo)
{
    io::RasterOptions options = raster_options(job, geo, "reasons (bit mask)");
    for (const auto& [bit, reason] : matcher::kReasonNames) {
        options.metadata[fmt::format("REASON_{:04X}", static_cast<unsigned>(bit))] = reason;
    }
    options.metadata["REASON_MASK_WITHOUT_VALUE"] =
        fmt::format("{:04X}", static_cast<unsigned>(matcher::kInvalidating));
    return options;
}

// A piece ready to be written.
struct Piece {
    Rect rect;
    matcher::Refined refined;
    std::optional<tiling::Image<float>> height;
    std::optional<tiling::Image<float>> depth;
};

class Writers {
public:
    Writers(const Job& job, Size size, const io::GeoReference& geo)
        : disparity_(job.outputs.disparity, size, io::PixelType::float32,
                     float_options(job, geo, "disparity", "pixel")),
          confidence_(job.outputs.confidence, size, io::PixelType::uint8,
                      raster_options(job, geo, "confidence (0 = no value)")),
          reasons_(job.outputs.reasons, size, io::PixelType::uint16, reason_options(job, geo))
    {
        if (!job.outputs.height.empty()) {
            height_.emplace(job.outputs.height, size, io::PixelType::float32,
                            float_options(job, geo, "height", "metre"));
        }
        if (!job.outputs.depth.empty()) {
            depth_.emplace(job.outputs.depth, size, io::PixelType::float32,
                           float_options(job, geo, "depth", "metre"));
        }
    }

    void write(const Piece& piece)
    {
        disparity_.write(piece.rect, piece.refined.disparity_px);
        confidence_.write(piece.rect, piece.refined.confidence);
        reasons_.write(piece.rect, piece.refined.reasons);
        if (height_) {
            height_->write(piece.rect, *piece.height);
        }
        if (depth_) {
            depth_->write(piece.rect, *piece.depth);
        }
    }

    void finish()
    {
        for_each([](io::GeoTiffWriter& writer) { writer.complete(); });
        for_each([](io::GeoTiffWriter& writer) { writer.publish(); });
    }

private:
    template <typename Action>
    void for_each(Action action)
    {
        for (auto* optional : {&height_, &depth_}) {
            if (*optional) {
                action(**optional);
            }
        }
        for (io::GeoTiffWriter* writer : {&confidence_, &reasons_, &disparity_}) {
            action(*writer);
        }
    }

    io::GeoTiffWriter disparity_;
    io::GeoTiffWriter confidence_;
    io::GeoTiffWriter reasons_;
    std::optional<io::GeoTiffWriter> height_;
    std::optional<io::GeoTiffWriter> depth_;
};

void count(const matcher::Refined& piece, MatchSummary& summary)
{
    for (const std::uint16_t reasons : piece.reasons.pixels()) {
        ++summary.pixels;
        summary.with_value += (reasons & matcher::kInvalidating) == 0;
        for (unsigned bit = 0; bit < 16; ++bit) {
            summary.with_reason[bit] += reasons >> bit & 1;
        }
    }
}

} // namespace

MatchSummary refine_and_write(const FirstPass& first_pass, const matcher::PairShape& shape,
                              const Job& job, const io::GeoReference& geo)
{
    const matcher::Options options = job.matcher.resolved();
    Writers writers(job, shape.left, geo);
    Pieces pieces(shape.left);
    MatchSummary summary;
    const auto next = [&](tbb::flow_control& control) -> Rect {
        check_stop();
        const auto piece = pieces.next();
        if (!piece) {
            control.stop();
            return {};
        }
        return *piece;
    };
    const auto compute = [&](const Rect& rect) {
        auto piece = std::make_shared<Piece>();
        piece->rect = rect;
        piece->refined = matcher::refine(rect, first_pass.read(rect, options), shape, options);
        if (!job.outputs.height.empty()) {
            piece->height = heights(piece->refined.disparity_px, job.geometry);
        }
        if (!job.outputs.depth.empty()) {
            piece->depth = depths(piece->refined.disparity_px, job.geometry);
        }
        return piece;
    };
    const auto write = [&](const std::shared_ptr<Piece>& piece) {
        writers.write(*piece);
        count(piece->refined, summary);
    };
    tbb::parallel_pipeline(
        kPiecesInFlight, tbb::make_filter<void, Rect>(tbb::filter_mode::serial_in_order, next) &
                             tbb::make_filter<Rect, std::shared_ptr<Piece>>(
                                 tbb::filter_mode::parallel, compute) &
                             tbb::make_filter<std::shared_ptr<Piece>, void>(
                                 tbb::filter_mode::serial_in_order, write));
    writers.finish();
    return summary;
}

std::int64_t refine_bytes(const matcher::PairShape& shape)
{
    const Rect piece = intersect({0, 0, kPieceRows + 4, kPieceCols + 4}, rect_of(shape.left));
    constexpr std::int64_t kInputBytes = 4 + 1 + 2 + 2; // the reasons are copied once
    constexpr std::int64_t kOutputBytes = 4 + 1 + 2 + 4 + 4;
    const std::int64_t keys = 4 * matcher::keys_of(piece, shape).area();
    return static_cast<std::int64_t>(kPiecesInFlight) *
           (piece.area() * (kInputBytes + kOutputBytes) + keys);
}

} // namespace hsgm::pipeline
