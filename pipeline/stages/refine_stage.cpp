#include "pipeline/stages/refine_stage.h"

#include "io/geotiff_writer.h"
#include "matcher/reasons.h"
#include "pipeline/error.h"
#include "pipeline/stages/height.h"
#include "pipeline/stages/stage_progress.h"

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

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
constexpr int kMostPiecesInFlight = 4;

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
        if (job.geometry.height_per_px_m) {
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

// One more than can be computed at once, so that writing need not wait.
int pieces_in_flight(int threads)
{
    return std::min(threads + 1, kMostPiecesInFlight);
}

matcher::RefineInput read_piece(const Rect& piece, const FirstPass& first_pass,
                                const PreparedPair& prepared, const matcher::PairShape& shape,
                                const matcher::Options& options)
{
    const matcher::RefineSupport support = matcher::refine_support(piece, shape, options);
    matcher::RefineInput input = first_pass.read(support);
    tiling::LevelSupport pixels;
    pixels.left_image = support.left_image;
    pixels.right_image = support.right_image;
    matcher::LevelImages images = prepared.read(0, pixels);
    input.left = std::move(images.left);
    input.right = std::move(images.right);
    return input;
}

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

MatchSummary refine_and_write(const FirstPass& first_pass, const PreparedPair& prepared,
                              const matcher::PairShape& shape, const Job& job,
                              const io::GeoReference& geo)
{
    const matcher::Options options = job.matcher.resolved();
    Writers writers(job, shape.left, geo);
    Pieces pieces(shape.left);
    MatchSummary summary;
    StageProgress progress(words_of_stage("refine"), shape.left.area());
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
        piece->refined = matcher::refine(
            rect, read_piece(rect, first_pass, prepared, shape, options), shape, options);
        if (job.geometry.height_per_px_m) {
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
        progress.advance(piece->rect.area());
    };
    tbb::parallel_pipeline(
        static_cast<std::size_t>(pieces_in_flight(tbb::this_task_arena::max_concurrency())),
        tbb::make_filter<void, Rect>(tbb::filter_mode::serial_in_order, next) &
            tbb::make_filter<Rect, std::shared_ptr<Piece>>(tbb::filter_mode::parallel,
                                                           compute) &
            tbb::make_filter<std::shared_ptr<Piece>, void>(tbb::filter_mode::serial_in_order,
                                                           write));
    writers.finish();
    return summary;
}

std::int64_t refine_bytes(const matcher::PairShape& shape, const matcher::Options& options,
                          int threads)
{
    // A piece in the middle of a large image, whose support is nowhere clipped.
    const auto middle_of = [](int length, int piece) {
        return std::max(0, std::min(length / 2, length - piece));
    };
    const Rect piece =
        intersect({middle_of(shape.left.rows, kPieceRows),
                   middle_of(shape.left.cols, kPieceCols), kPieceRows, kPieceCols},
                  rect_of(shape.left));
    constexpr std::int64_t kHeightAndDepth = 4 + 4;
    return pieces_in_flight(threads) *
           (matcher::refine_bytes(piece, shape, options.resolved()) +
            piece.area() * kHeightAndDepth);
}

} // namespace hsgm::pipeline
