#include "pipeline/bench/contenders.h"

#include <utility>

namespace hsgm::bench {

namespace {

std::string title_of(const matcher::Options& options,
                     const std::optional<matcher::Instructions>& set)
{
    std::string title = "hsgm " + std::string(name(options.cost));
    if (options.mode != matcher::Mode::hsgm) {
        title = std::string(name(options.mode)) + " " + std::string(name(options.cost));
    }
    if (set) {
        title += ", " + std::string(name(*set));
    }
    return title;
}

class List {
public:
    explicit List(const BenchSettings& settings) : settings_(settings) {}

    std::size_t add(std::string title, int threads, std::size_t base)
    {
        Contender c;
        c.title = std::move(title);
        c.options = settings_.options;
        c.options.cost = settings_.costs.front();
        c.instructions = base_instructions();
        c.threads = threads;
        c.base = base;
        all_.push_back(std::move(c));
        return all_.size() - 1;
    }
    std::size_t add_base(int threads, std::size_t compared_with)
    {
        const std::size_t i = add("", threads, compared_with);
        all_[i].title = title_of(all_[i].options, all_[i].instructions);
        return i;
    }
    void add_peers(int threads, std::size_t compared_with)
    {
        for (const Peer peer : settings_.peers) {
            all_[add(title(peer), threads, compared_with)].peer = peer;
        }
    }
    Contender& operator[](std::size_t i) { return all_[i]; }
    std::vector<Contender> take() { return std::move(all_); }

private:
    std::optional<matcher::Instructions> base_instructions() const
    {
        return settings_.instructions.empty() ? std::nullopt
                                              : std::optional(settings_.instructions.front());
    }

    const BenchSettings& settings_;
    std::vector<Contender> all_;
};

// The base with one thing changed.
void add_variants(const BenchSettings& settings, List& list)
{
    const int threads = settings.threads.front();
    if (list[0].options.resolved().prune) {
        Contender& unpruned = list[list.add(list[0].title + ", not pruned", threads, 0)];
        unpruned.options.prune = false;
    }
    for (std::size_t i = 1; i < settings.instructions.size(); ++i) {
        Contender& other = list[list.add("", threads, 0)];
        other.instructions = settings.instructions[i];
        other.title = title_of(other.options, other.instructions);
    }
    for (std::size_t i = 1; i < settings.costs.size(); ++i) {
        Contender& other = list[list.add("", threads, 0)];
        other.options.cost = settings.costs[i];
        other.title = title_of(other.options, other.instructions);
    }
}

// The base on a device, the same without pruning, and other costs.
void add_device(const BenchSettings& settings, const matcher::cuda::DeviceInfo& device,
                List& list)
{
    const int threads = settings.threads.front();
    const auto add = [&](matcher::Cost cost, bool prune) {
        Contender& c = list[list.add("", threads, 0)];
        c.device = device;
        c.options.cost = cost;
        c.options.prune = prune;
        c.title = title_of(c.options, std::nullopt) +
                  ", cuda:" + std::to_string(device.number) + (prune ? "" : ", not pruned");
    };
    const bool prunes = list[0].options.resolved().prune;
    add(settings.costs.front(), prunes);
    if (prunes) {
        add(settings.costs.front(), false);
    }
    for (std::size_t i = 1; i < settings.costs.size(); ++i) {
        add(settings.costs[i], prunes);
    }
}

} // namespace

std::vector<Contender> contenders(const BenchSettings& settings)
{
    List list(settings);
    list.add_base(settings.threads.front(), 0);
    add_variants(settings, list);
    for (const auto& device : settings.devices) {
        add_device(settings, device, list);
    }
    list.add_peers(settings.threads.front(), 0);
    for (std::size_t i = 1; i < settings.threads.size(); ++i) {
        const std::size_t base = list.add_base(settings.threads[i], 0);
        list.add_peers(settings.threads[i], base);
    }
    return list.take();
}

} // namespace hsgm::bench
