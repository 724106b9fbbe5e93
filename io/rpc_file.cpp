// Rational polynomial models from files that are given by name. Each reader turns its
// notation into the items of GDAL's RPC domain.

#include "io/error.h"
#include "io/gdal_private.h"
#include "io/rpc_items_private.h"

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <memory>
#include <sstream>
#include <utility>

namespace hsgm::io {

namespace {

constexpr std::array<const char*, 4> kPolynomials{"LINE_NUM_COEFF", "LINE_DEN_COEFF",
                                                  "SAMP_NUM_COEFF", "SAMP_DEN_COEFF"};

/// Larger than any model by far; a raster given by mistake must not be read as text.
constexpr vsi_l_offset kLargestFile = 4 << 20;

std::string read_text(const std::string& path)
{
    ErrorCollector errors;
    GByte* data = nullptr;
    vsi_l_offset size = 0;
    VSIStatBufL status;
    if (VSIStatL(path.c_str(), &status) != 0) {
        throw InputError("There is no RPC file " + path + ".");
    }
    if (VSIIngestFile(nullptr, path.c_str(), &data, &size, kLargestFile) == FALSE) {
        throw InputError("Cannot read the RPC file " + path + "; " + errors.quote() + ".");
    }
    std::string text(reinterpret_cast<const char*>(data), static_cast<std::size_t>(size));
    CPLFree(data);
    return text;
}

std::string trimmed(const std::string& text)
{
    const char* const blanks = " \t\r\n";
    const auto first = text.find_first_not_of(blanks);
    return first == std::string::npos
               ? ""
               : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string upper(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return text;
}

/// The 20 numbered values of each polynomial, joined; `name_of(polynomial, i)` is the key.
template <typename NameOf>
void join_coefficients(RpcItems& items, NameOf name_of)
{
    for (const char* polynomial : kPolynomials) {
        std::string joined;
        for (int i = 0; i < 20; ++i) {
            const auto item = items.find(name_of(polynomial, i));
            if (item == items.end()) {
                return; // the missing polynomial is reported with the other keys
            }
            joined += item->second + " ";
        }
        items[polynomial] = joined;
    }
}

/// RPC00A has the same terms in another order (OSSIM, ossimRpcModel::polynomial).
void reorder_rpc00a(RpcItems& items)
{
    constexpr std::array<int, 20> kTermOfA{0, 1,  2,  3,  4,  5,  6,  8,  9,  10,
                                           7, 11, 14, 17, 12, 15, 18, 13, 16, 19};
    for (const char* polynomial : kPolynomials) {
        std::istringstream words(items[polynomial]);
        std::array<std::string, 20> given;
        std::for_each(given.begin(), given.end(), [&](std::string& word) { words >> word; });
        std::string joined;
        for (const int term : kTermOfA) {
            joined += given[static_cast<std::size_t>(term)] + " ";
        }
        items[polynomial] = joined;
    }
}

/// "KEY: value" a line: _RPC.TXT counts coefficients from 1, .geom from 00.
RpcItems read_lines(const std::string& text)
{
    RpcItems items;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const auto colon = line.find(':');
        if (colon != std::string::npos) {
            items[upper(trimmed(line.substr(0, colon)))] = trimmed(line.substr(colon + 1));
        }
    }
    const bool geom = items.contains("LINE_NUM_COEFF_00");
    join_coefficients(items, [&](const std::string& polynomial, int i) {
        const std::string number = std::to_string(geom ? i : i + 1);
        return polynomial + (geom && i < 10 ? "_0" : "_") + number;
    });
    if (items.contains("POLYNOMIAL_FORMAT") && items["POLYNOMIAL_FORMAT"] == "A") {
        reorder_rpc00a(items);
    }
    return items;
}

/// "lineOffset = 12;", "lineNumCoef = ( 1, 2, ... );"
RpcItems read_rpb(const std::string& text)
{
    constexpr std::array<std::pair<const char*, const char*>, 14> kKeys{{
        {"lineOffset", "LINE_OFF"},
        {"sampOffset", "SAMP_OFF"},
        {"latOffset", "LAT_OFF"},
        {"longOffset", "LONG_OFF"},
        {"heightOffset", "HEIGHT_OFF"},
        {"lineScale", "LINE_SCALE"},
        {"sampScale", "SAMP_SCALE"},
        {"latScale", "LAT_SCALE"},
        {"longScale", "LONG_SCALE"},
        {"heightScale", "HEIGHT_SCALE"},
        {"lineNumCoef", kPolynomials[0]},
        {"lineDenCoef", kPolynomials[1]},
        {"sampNumCoef", kPolynomials[2]},
        {"sampDenCoef", kPolynomials[3]},
    }};
    RpcItems items;
    std::istringstream statements(text);
    for (std::string statement; std::getline(statements, statement, ';');) {
        const auto equals = statement.rfind('=');
        if (equals == std::string::npos) {
            continue;
        }
        // "BEGIN_GROUP = IMAGE" has no semicolon, so it may stand before the key.
        std::istringstream words(statement.substr(0, equals));
        std::string key;
        while (words >> key) {
        }
        std::string value = statement.substr(equals + 1);
        std::erase_if(value, [](char c) { return c == '(' || c == ')'; });
        for (const auto& [theirs, ours] : kKeys) {
            if (key == theirs) {
                items[ours] = trimmed(value);
            }
        }
    }
    return items;
}

bool is_image(const std::string& path)
{
    const std::string end = upper(CPLGetExtension(path.c_str()));
    return end == "TIF" || end == "TIFF" || end == "JP2" || end == "NTF" || end == "VRT";
}

struct XmlCloser {
    void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};

/// The number that a text holds, less one.
std::string one_less(const std::string& text)
{
    std::array<char, 32> digits{};
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), CPLAtof(text.c_str()) - 1);
    return {digits.data(), end.ptr};
}

/// DIMAP: <Inverse_Model> (Pleiades Neo: <ImagetoGround_Values> beside
/// <GroundtoImage_Values>) holds the model from ground to image, <RFM_Validity> the rest.
RpcItems read_dimap(const std::string& text, const std::string& path)
{
    ErrorCollector errors;
    const std::unique_ptr<CPLXMLNode, XmlCloser> root(CPLParseXMLString(text.c_str()));
    if (root == nullptr) {
        throw InputError("Cannot read " + path + " as XML; " + errors.quote() + ".");
    }
    const CPLXMLNode* model = CPLSearchXMLNode(root.get(), "=Inverse_Model");
    model = model != nullptr ? model : CPLSearchXMLNode(root.get(), "=GroundtoImage_Values");
    const CPLXMLNode* validity = CPLSearchXMLNode(root.get(), "=RFM_Validity");
    RpcItems items;
    for (const CPLXMLNode* parent : {model, validity}) {
        for (const CPLXMLNode* node = parent == nullptr ? nullptr : parent->psChild;
             node != nullptr; node = node->psNext) {
            if (node->eType == CXT_Element) {
                items[node->pszValue] = CPLGetXMLValue(node, nullptr, "");
            }
        }
    }
    join_coefficients(items, [](const std::string& polynomial, int i) {
        return polynomial + "_" + std::to_string(i + 1);
    });
    // SPOT and Pleiades call the first pixel (1, 1), Pleiades Neo (0, 0).
    const CPLXMLNode* profile = CPLSearchXMLNode(root.get(), "=METADATA_PROFILE");
    const bool neo = profile != nullptr &&
                     std::string(CPLGetXMLValue(profile, nullptr, "")).starts_with("PNEO");
    for (const char* key : {"LINE_OFF", "SAMP_OFF"}) {
        if (!neo && items.contains(key)) {
            items[key] = one_less(items[key]);
        }
    }
    return items;
}

} // namespace

std::string geom_beside(const std::string& image)
{
    const std::string geom = CPLResetExtension(image.c_str(), "geom");
    VSIStatBufL status;
    return VSIStatL(geom.c_str(), &status) == 0 ? geom : "";
}

RpcMetadata read_rpc_file(const std::string& path)
{
    if (is_image(path)) {
        if (auto stored = stored_rpc(RasterSource(ImageSpec{path}))) {
            return *stored;
        }
        throw InputError("The image " + path +
                         " is named for its RPC, but GDAL finds none in it "
                         "or beside it.");
    }
    const std::string text = read_text(path);
    const bool xml = trimmed(text).starts_with('<');
    const bool rpb = text.find("lineOffset") != std::string::npos;
    const RpcItems items = xml   ? read_dimap(text, path)
                           : rpb ? read_rpb(text)
                                 : read_lines(text);
    if (!items.contains("LINE_OFF") && !items.contains("LINE_NUM_COEFF")) {
        throw InputError(path + " holds no RPC; expected _RPC.TXT, .RPB, .geom, DIMAP's "
                                "RPC_*.XML, or an image that has one.");
    }
    RpcMetadata rpc = rpc_from_items(items, path);
    rpc.of_whole_scene = items.contains("LINE_NUM_COEFF_00");
    return rpc;
}

} // namespace hsgm::io
