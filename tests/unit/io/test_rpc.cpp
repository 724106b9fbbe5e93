#include "io/error.h"
#include "io/rpc_metadata.h"
#include "tests/unit/io/sample_rasters.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iomanip>
#include <sstream>

using namespace hsgm;
using namespace hsgm::io;
using samples::make_raster;
using samples::TemporaryFolder;

namespace {

RpcMetadata sample()
{
    RpcMetadata rpc;
    rpc.line_off = 1234.5;
    rpc.samp_off = -17.25;
    rpc.lat_off = -21.2316081288;
    rpc.long_off = 55.7119698801;
    rpc.height_off = 1295;
    rpc.line_scale = 19404;
    rpc.samp_scale = 20000;
    rpc.lat_scale = 0.09;
    rpc.long_scale = 0.1;
    rpc.height_scale = 1315;
    for (std::size_t i = 0; i < 20; ++i) {
        const double n = static_cast<double>(i);
        rpc.line_num[i] = 1e-3 * n + 0.5;
        rpc.line_den[i] = -2e-9 * n + 1;
        rpc.samp_num[i] = 3e-7 * n - 0.25;
        rpc.samp_den[i] = 1.0 / (n + 3);
    }
    return rpc;
}

std::string digits(double value)
{
    std::ostringstream text;
    text.precision(17);
    text << value;
    return text.str();
}

// Calls `use(key, number)` for the ten offsets and scales, then for each of the polynomials
// `use(key, numbers)`.
template <typename Use>
void for_each_item(const RpcMetadata& rpc, Use use)
{
    use("LINE_OFF", std::vector{rpc.line_off});
    use("SAMP_OFF", std::vector{rpc.samp_off});
    use("LAT_OFF", std::vector{rpc.lat_off});
    use("LONG_OFF", std::vector{rpc.long_off});
    use("HEIGHT_OFF", std::vector{rpc.height_off});
    use("LINE_SCALE", std::vector{rpc.line_scale});
    use("SAMP_SCALE", std::vector{rpc.samp_scale});
    use("LAT_SCALE", std::vector{rpc.lat_scale});
    use("LONG_SCALE", std::vector{rpc.long_scale});
    use("HEIGHT_SCALE", std::vector{rpc.height_scale});
    use("LINE_NUM_COEFF", std::vector(rpc.line_num.begin(), rpc.line_num.end()));
    use("LINE_DEN_COEFF", std::vector(rpc.line_den.begin(), rpc.line_den.end()));
    use("SAMP_NUM_COEFF", std::vector(rpc.samp_num.begin(), rpc.samp_num.end()));
    use("SAMP_DEN_COEFF", std::vector(rpc.samp_den.begin(), rpc.samp_den.end()));
}

// A raster with the model in its tag and, by GDAL's option, in a file beside it.
void make_with_rpc(const std::string& path, const RpcMetadata& rpc, const std::string& option)
{
    make_raster(path, GDT_Byte, {1, 1}, {{0}},
                [&](GDALDatasetH dataset) {
                    for_each_item(rpc, [&](const char* key, const std::vector<double>& values) {
                        std::string text;
                        for (const double value : values) {
                            text += digits(value) + " ";
                        }
                        GDALSetMetadataItem(dataset, key, text.c_str(), "RPC");
                    });
                },
                {option});
}

// Suffixes of coefficients: "_1" to "_20", or "_00" to "_19".
std::string from_one(std::size_t i)
{
    std::ostringstream text;
    text << '_' << i + 1;
    return text.str();
}

std::string from_zero(std::size_t i)
{
    std::ostringstream text;
    text << '_' << std::setw(2) << std::setfill('0') << i;
    return text.str();
}

// Lines "KEY: value".
std::string as_lines(const RpcMetadata& rpc, std::string (*suffix)(std::size_t))
{
    std::ostringstream text;
    for_each_item(rpc, [&](const char* key, const std::vector<double>& values) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            text << key << (values.size() == 1 ? "" : suffix(i)) << ":  " << digits(values[i])
                 << '\n';
        }
    });
    return text.str();
}

std::string as_dimap(const RpcMetadata& rpc, const std::string& profile)
{
    std::ostringstream model;
    std::ostringstream validity;
    for_each_item(rpc, [&](const char* key, const std::vector<double>& values) {
        std::ostringstream& part = values.size() == 1 ? validity : model;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::string name = key + (values.size() == 1 ? "" : from_one(i));
            part << '<' << name << '>' << digits(values[i]) << "</" << name << ">\n";
        }
    });
    std::ostringstream text;
    text << "<?xml version=\"1.0\"?>\n<Dimap_Document><Metadata_Identification>"
         << "<METADATA_PROFILE>" << profile << "</METADATA_PROFILE></Metadata_Identification>"
         << "<Rational_Function_Model><Global_RFM><Inverse_Model>" << model.str()
         << "</Inverse_Model><RFM_Validity>" << validity.str()
         << "</RFM_Validity></Global_RFM></Rational_Function_Model></Dimap_Document>";
    return text.str();
}

std::string put(const TemporaryFolder& folder, const std::string& name, const std::string& text)
{
    std::ofstream(folder / name) << text;
    return folder / name;
}

RpcMetadata without_origin(RpcMetadata rpc)
{
    rpc.origin.clear();
    return rpc;
}

// GDAL writes numbers with 15 digits.
void check_close(const RpcMetadata& rpc, const RpcMetadata& expected)
{
    std::vector<double> values;
    std::vector<double> others;
    const auto gather = [](std::vector<double>& all) {
        return [&all](const char*, const std::vector<double>& some) {
            all.insert(all.end(), some.begin(), some.end());
        };
    };
    for_each_item(rpc, gather(values));
    for_each_item(expected, gather(others));
    for (std::size_t i = 0; i < values.size(); ++i) {
        CAPTURE(i);
        CHECK(values[i] == Approx(others[i]).epsilon(1e-13));
    }
}

std::string refusal(const std::string& path)
{
    try {
        read_rpc_file(path);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no refusal";
}

} // namespace

TEST_CASE("an RPC in the TIFF tag is found as it was stored")
{
    const TemporaryFolder folder;
    make_with_rpc(folder / "a.tif", sample(), "RPB=NO");
    const auto rpc = stored_rpc(RasterSource({folder / "a.tif"}));
    REQUIRE(rpc.has_value());
    check_close(*rpc, sample());
    CHECK(rpc->origin == folder / "a.tif" + ", band 1");
}

TEST_CASE("an image without RPC has none")
{
    const TemporaryFolder folder;
    make_raster(folder / "a.tif", GDT_Byte, {1, 1}, {{0}});
    CHECK_FALSE(stored_rpc(RasterSource({folder / "a.tif"})).has_value());
}

TEST_CASE("RPC files that GDAL writes read back as what went in")
{
    const TemporaryFolder folder;
    make_with_rpc(folder / "a.tif", sample(), "RPB=YES");
    make_with_rpc(folder / "b.tif", sample(), "RPCTXT=YES");
    for (const char* name : {"a.RPB", "b_RPC.TXT"}) {
        const RpcMetadata rpc = read_rpc_file(folder / name);
        check_close(rpc, sample());
        CHECK_FALSE(rpc.of_whole_scene);
    }
}

TEST_CASE("signs, leading zeros and units in RPC files are understood")
{
    const TemporaryFolder folder;
    std::string text = as_lines(sample(), from_one);
    text.replace(text.find("LINE_OFF:  1234.5"), 17, "LINE_OFF: +001234.50 pixels");
    CHECK(without_origin(read_rpc_file(put(folder, "a_RPC.TXT", text))) == sample());
}

TEST_CASE("a .geom file is read, and is of the whole scene")
{
    const TemporaryFolder folder;
    std::string text = "type:  ossimRpcModel\npolynomial_format:  B\n";
    text += as_lines(sample(), from_zero);
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) {
        return c == 'B' ? 'B' : static_cast<char>(std::tolower(c)); // format B is a value
    });
    const RpcMetadata rpc = read_rpc_file(put(folder, "a.geom", text));
    RpcMetadata expected = sample();
    expected.of_whole_scene = true;
    CHECK(without_origin(rpc) == expected);
}

TEST_CASE("the terms of format A are put into the order of format B")
{
    // A: 1 L P H LP LH PH LPH LL PP HH LLL LLP LLH LPP PPP PPH LHH PHH HHH, here numbered
    // 0 to 19; B has the products in another order.
    const TemporaryFolder folder;
    RpcMetadata given = sample();
    for (std::size_t i = 0; i < 20; ++i) {
        given.line_num[i] = static_cast<double>(i);
    }
    std::string text = "POLYNOMIAL_FORMAT: A\n";
    text += as_lines(given, from_zero);
    const RpcMetadata rpc = read_rpc_file(put(folder, "a.geom", text));
    CHECK(rpc.line_num == std::array<double, 20>{0, 1,  2,  3,  4,  5,  6,  8,  9,  10,
                                                 7, 11, 14, 17, 12, 15, 18, 13, 16, 19});
}

TEST_CASE("DIMAP counts pixels from 1, and Pleiades Neo from 0")
{
    const TemporaryFolder folder;
    RpcMetadata less_one = sample();
    less_one.line_off -= 1;
    less_one.samp_off -= 1;
    const std::string pleiades = put(folder, "a.XML", as_dimap(sample(), "PHR_SENSOR"));
    const std::string neo = put(folder, "b.XML", as_dimap(sample(), "PNEO_SENSOR"));
    CHECK(without_origin(read_rpc_file(pleiades)) == less_one);
    CHECK(without_origin(read_rpc_file(neo)) == sample());
}

TEST_CASE("RPC files that cannot be used are refused with what is wrong")
{
    const TemporaryFolder folder;
    const std::string good = as_lines(sample(), from_one);
    const auto changed = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        text.replace(text.find(from), from.size(), to);
        return put(folder, "x_RPC.TXT", text);
    };
    CHECK(refusal(folder / "none.txt") ==
          "There is no RPC file " + (folder / "none.txt") + ".");
    CHECK(refusal(put(folder, "a.txt", "hello\n")).find("holds no RPC") != std::string::npos);
    CHECK(refusal(put(folder, "a.xml", "<a><b></a>")).find("as XML; GDAL says: ") !=
          std::string::npos);
    CHECK(refusal(changed("LONG_SCALE", "LOOONG_SCALE")).find("has no LONG_SCALE") !=
          std::string::npos);
    CHECK(refusal(changed("SAMP_DEN_COEFF_20", "SAMP_DEN_COEFF_21"))
              .find("has no SAMP_DEN_COEFF") != std::string::npos);
    CHECK(refusal(changed("HEIGHT_OFF:  1295", "HEIGHT_OFF:  high"))
              .find("has 'high' for HEIGHT_OFF; expected 1 number") != std::string::npos);
    CHECK(refusal(changed("LAT_SCALE:  0.089999999999999997", "LAT_SCALE: 0"))
              .find("a scale of 0") != std::string::npos);
}

TEST_CASE("a .geom beside an image is found by the image's name")
{
    const TemporaryFolder folder;
    CHECK(geom_beside(folder / "a.b.tif").empty());
    put(folder, "a.b.geom", "");
    CHECK(geom_beside(folder / "a.b.tif") == folder / "a.b.geom");
    CHECK(geom_beside(folder / "a.tif").empty());
}
