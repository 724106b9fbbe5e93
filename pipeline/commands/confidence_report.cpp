#include "pipeline/commands/confidence_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace hsgm::pipeline {

void print_confidence(const evaluate::ConfidenceScore& s)
{
    fmt::print("\nleast confident dropped   error above {:g} px among the rest\n",
               s.threshold_px);
    for (const evaluate::Sparsified& point : s.curve) {
        fmt::print("{:12g} % {:28.3f} %\n", point.dropped_percent, point.bad_percent);
    }
    fmt::print(
        "area under that curve {:17.3f} %   (no confidence could do better than {:.3f} %)\n",
        s.area_percent, s.optimal_area_percent);
    fmt::print("\nconfidence / 255        share   mean confidence   within {:g} px\n",
               s.threshold_px);
    const auto rows = evaluate::calibration(s);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double low = static_cast<double>(i) / 10;
        if (rows[i].share > 0) {
            fmt::print("{:.1f} to {:.1f} {:17.3f} % {:17.3f} {:13.3f}\n", low, low + 0.1,
                       100 * rows[i].share, rows[i].confidence, rows[i].within);
        }
    }
    fmt::print("mean distance of the last two {:.4f}\n", s.calibration_error);
}

nlohmann::ordered_json confidence_json(const evaluate::ConfidenceScore& s)
{
    auto curve = nlohmann::ordered_json::array();
    for (const evaluate::Sparsified& point : s.curve) {
        curve.push_back(
            {{"dropped_percent", point.dropped_percent}, {"bad_percent", point.bad_percent}});
    }
    auto classes = nlohmann::ordered_json::array();
    for (const evaluate::ConfidenceClass& c : s.classes) {
        classes.push_back(
            {{"confidence", c.confidence}, {"pixels", c.pixels}, {"within", c.within}});
    }
    return {{"threshold_px", s.threshold_px},
            {"answered_pixels", s.answered},
            {"curve", curve},
            {"area_percent", s.area_percent},
            {"optimal_area_percent", s.optimal_area_percent},
            {"calibration_error", s.calibration_error},
            {"classes", classes}};
}

} // namespace hsgm::pipeline
