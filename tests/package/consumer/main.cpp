// Uses what is installed: headers by their folder's name, libraries through the CMake package.
#include <tiling/tile_plan.h>

#ifdef WITH_MATCHER
#include <matcher/options.h>
#endif

int main()
{
    const hsgm::tiling::TilePlan plan({100, 250}, 100);
    bool good = plan.count() == 3;
#ifdef WITH_MATCHER
    good = good && hsgm::matcher::name(hsgm::matcher::Options{}.mode) == "hsgm";
#endif
    return good ? 0 : 1;
}
