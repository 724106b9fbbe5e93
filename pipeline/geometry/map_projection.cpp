#include "pipeline/geometry/map_projection.h"

#include <proj.h>
#include <proj_experimental.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hsgm::geometry {

namespace {

struct ContextCloser {
    void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
};
struct ProjCloser {
    void operator()(PJ* object) const { proj_destroy(object); }
};
using Context = std::unique_ptr<PJ_CONTEXT, ContextCloser>;
using Object = std::unique_ptr<PJ, ProjCloser>;

/// PROJ reports to a callback; the last words are quoted in our own sentence.
void keep_last(void* words, int, const char* text)
{
    *static_cast<std::string*>(words) = text;
}

std::string said(const std::string& words)
{
    return words.empty() ? "" : " (PROJ says: " + words + ")";
}

Object create(PJ_CONTEXT* context, const std::string& text, const std::string& words)
{
    Object object(proj_create(context, text.c_str()));
    if (object == nullptr || proj_is_crs(object.get()) == 0) {
        throw std::invalid_argument("'" + text +
                                    "' is no coordinate reference system that PROJ knows" +
                                    said(words) + "; write for example EPSG:32740");
    }
    return object;
}

/// EGM96 is known by that name to people, and by number to PROJ.
std::string vertical_code(std::string name)
{
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return name == "EGM96" ? "EPSG:5773" : name == "EGM2008" ? "EPSG:3855" : name;
}

bool has_vertical(PJ_CONTEXT* context, const PJ* crs)
{
    return proj_get_type(crs) == PJ_TYPE_COMPOUND_CRS ||
           (proj_get_type(crs) == PJ_TYPE_BOUND_CRS &&
            has_vertical(context, Object(proj_get_source_crs(context, crs)).get()));
}

bool metric_axes(PJ_CONTEXT* context, const PJ* crs)
{
    const Object horizontal(proj_get_type(crs) == PJ_TYPE_COMPOUND_CRS
                                ? proj_crs_get_sub_crs(context, crs, 0)
                                : nullptr);
    const Object system(
        proj_crs_get_coordinate_system(context, horizontal ? horizontal.get() : crs));
    for (const int axis : {0, 1}) {
        const char* unit = nullptr;
        double to_si = 0;
        if (system == nullptr ||
            proj_cs_get_axis_info(context, system.get(), axis, nullptr, nullptr, nullptr,
                                  &to_si, &unit, nullptr, nullptr) == 0 ||
            to_si != 1 || unit == nullptr || std::string(unit) != "metre") {
            return false;
        }
    }
    return true;
}

/// The name of a grid that an operation from WGS84 would need and that is not there.
std::string missing_grid(PJ_CONTEXT* context, const PJ* source, const PJ* target)
{
    PJ_OPERATION_FACTORY_CONTEXT* factory =
        proj_create_operation_factory_context(context, nullptr);
    proj_operation_factory_context_set_grid_availability_use(context, factory,
                                                             PROJ_GRID_AVAILABILITY_IGNORED);
    proj_operation_factory_context_set_allow_ballpark_transformations(context, factory, 0);
    PJ_OBJ_LIST* list = proj_create_operations(context, source, target, factory);
    std::string missing;
    for (int i = 0; list != nullptr && missing.empty() && i < proj_list_get_count(list); ++i) {
        const Object operation(proj_list_get(context, list, i));
        const int grids = proj_coordoperation_get_grid_used_count(context, operation.get());
        for (int g = 0; g < grids; ++g) {
            const char* name = nullptr;
            int available = 1;
            proj_coordoperation_get_grid_used(context, operation.get(), g, &name, nullptr,
                                              nullptr, nullptr, nullptr, nullptr, &available);
            if (available == 0 && name != nullptr) {
                missing = name;
            }
        }
    }
    proj_list_destroy(list);
    proj_operation_factory_context_destroy(factory);
    return missing;
}

} // namespace

struct MapProjection::Handles {
    std::string crs_text;
    std::string vertical_text;
    std::string words; // outlives the context, which writes to it
    Context context;
    Object to_map;
    std::string name;
    std::string height_name;
    std::string wkt;
    bool in_metres = false;

    Object make_target();
    void describe(const PJ* target);
    void connect(const PJ* target);
};

Object MapProjection::Handles::make_target()
{
    Object target = create(context.get(), crs_text, words);
    if (proj_get_type(target.get()) == PJ_TYPE_GEOCENTRIC_CRS ||
        proj_get_type(target.get()) == PJ_TYPE_VERTICAL_CRS) {
        throw std::invalid_argument("'" + crs_text +
                                    "' is no map: choose a projected or geographic coordinate "
                                    "reference system, for example EPSG:32740");
    }
    if (vertical_text.empty()) {
        return target;
    }
    if (has_vertical(context.get(), target.get())) {
        throw std::invalid_argument("'" + crs_text +
                                    "' has a vertical datum of its own; give '" +
                                    vertical_text + "' with a horizontal one");
    }
    const Object vertical = create(context.get(), vertical_code(vertical_text), words);
    if (proj_get_type(vertical.get()) != PJ_TYPE_VERTICAL_CRS) {
        throw std::invalid_argument("'" + vertical_text +
                                    "' is no vertical datum; write for example EGM96, or "
                                    "EPSG:5773");
    }
    Object flat(proj_crs_demote_to_2D(context.get(), nullptr, target.get()));
    const std::string both =
        std::string(proj_get_name(target.get())) + " + " + proj_get_name(vertical.get());
    return Object(
        proj_create_compound_crs(context.get(), both.c_str(), flat.get(), vertical.get()));
}

void MapProjection::Handles::describe(const PJ* target)
{
    name = proj_get_name(target);
    height_name = "height above the WGS84 ellipsoid";
    if (has_vertical(context.get(), target)) {
        const Object vertical(proj_crs_get_sub_crs(context.get(), target, 1));
        height_name = vertical == nullptr ? name : proj_get_name(vertical.get());
    }
    const char* text = proj_as_wkt(context.get(), target, PJ_WKT2_2019, nullptr);
    wkt = text == nullptr ? "" : text;
    in_metres = metric_axes(context.get(), target);
}

void MapProjection::Handles::connect(const PJ* target)
{
    const Object wgs84 = create(context.get(), "EPSG:4979", words);
    const bool vertical = has_vertical(context.get(), target);
    const Object deep(vertical ? nullptr
                               : proj_crs_promote_to_3D(context.get(), nullptr, target));
    const PJ* const there = deep ? deep.get() : target;
    // Without a proper way, PROJ would pretend that the datums are the same.
    const char* const options[] = {"ALLOW_BALLPARK=NO", nullptr};
    const Object operation(
        proj_create_crs_to_crs_from_pj(context.get(), wgs84.get(), there, nullptr, options));
    to_map.reset(operation == nullptr
                     ? nullptr
                     : proj_normalize_for_visualization(context.get(), operation.get()));
    const std::string grid = missing_grid(context.get(), wgs84.get(), there);
    if (to_map == nullptr) {
        throw std::invalid_argument(
            "PROJ knows no way from WGS84 to '" + name + "'" +
            (grid.empty() ? said(words)
                          : "; it would need the grid " + grid + ", which is not installed"));
    }
}

MapProjection::MapProjection(std::unique_ptr<Handles> handles) : handles_(std::move(handles)) {}
MapProjection::~MapProjection() = default;
MapProjection::MapProjection(MapProjection&&) noexcept = default;
MapProjection& MapProjection::operator=(MapProjection&&) noexcept = default;

MapProjection MapProjection::from_text(const std::string& crs, const std::string& vertical)
{
    auto handles = std::make_unique<Handles>();
    handles->crs_text = crs;
    handles->vertical_text = vertical;
    handles->context.reset(proj_context_create());
    proj_log_func(handles->context.get(), &handles->words, keep_last);
    proj_context_set_enable_network(handles->context.get(), 0);
    const Object target = handles->make_target();
    handles->describe(target.get());
    handles->connect(target.get());
    return MapProjection(std::move(handles));
}

MapProjection MapProjection::automatic(double longitude_deg, double latitude_deg)
{
    if (latitude_deg > 84) {
        return from_text("EPSG:5041"); // UPS North, axes east and north
    }
    if (latitude_deg < -80) {
        return from_text("EPSG:5042");
    }
    const double wrapped = longitude_deg - 360 * std::floor((longitude_deg + 180) / 360);
    const int zone = std::min(static_cast<int>((wrapped + 180) / 6) + 1, 60);
    return from_text("EPSG:" + std::to_string((latitude_deg < 0 ? 32700 : 32600) + zone));
}

MapProjection MapProjection::copy() const
{
    return from_text(handles_->crs_text, handles_->vertical_text);
}

MapPoint MapProjection::forward(const GeodeticPoint& ground) const
{
    const PJ_COORD there =
        proj_trans(handles_->to_map.get(), PJ_FWD,
                   proj_coord(ground.longitude_deg, ground.latitude_deg, ground.height_m, 0));
    return {there.xyz.x, there.xyz.y, there.xyz.z};
}

GeodeticPoint MapProjection::inverse(const MapPoint& place) const
{
    const PJ_COORD here = proj_trans(handles_->to_map.get(), PJ_INV,
                                     proj_coord(place.x, place.y, place.height_m, 0));
    return {here.xyz.x, here.xyz.y, here.xyz.z};
}

std::string MapProjection::text() const
{
    return handles_->vertical_text.empty() ? handles_->crs_text
                                           : handles_->crs_text + "+" + handles_->vertical_text;
}

const std::string& MapProjection::name() const
{
    return handles_->name;
}

const std::string& MapProjection::height_name() const
{
    return handles_->height_name;
}

const std::string& MapProjection::wkt() const
{
    return handles_->wkt;
}

bool MapProjection::in_metres() const
{
    return handles_->in_metres;
}

} // namespace hsgm::geometry
