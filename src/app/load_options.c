/* load_options.c - see load_options.h. */
#include "app/load_options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/flag.h"
#include "base/sorted.h"
#include "base/units.h"
#include "study/load.h"

/* Loads between LOW and HIGH without a step; a message of a cache line; a run of some seconds. */
enum { POINTS = 20, DEFAULT_MESSAGES = 400000 };

/* "a,b(1,2),c" at the commas outside of brackets, into words of `a`. */
static bool split(const char *option, const char *text, const char **word, int *n, int most,
                  struct arena *a, struct err *e)
{
    int depth = 0;
    *n = 0;
    for (const char *from = text, *at = text;; at++) {
        depth += (*at == '(') - (*at == ')');
        if (*at != '\0' && (*at != ',' || depth > 0)) continue;
        if (at == from)
            return err_set(e, ERR_USAGE, "%s: '%.80s' has an empty entry", option, text);
        if (*n == most) return err_set(e, ERR_USAGE, "%s: more than %d entries", option, most);
        char *copy = arena_text(a, from);
        copy[at - from] = '\0';
        word[(*n)++] = copy;
        if (*at == '\0') return true;
        from = at + 1;
    }
}

/* One number with nothing behind it. */
static bool number_of(const char *text, double *x)
{
    char *end;
    *x = strtod(text, &end);
    return end != text && *end == '\0' && isfinite(*x);
}

/* A load in flits per node and cycle; above 1 a node cannot send. */
static bool add_rate(struct load_options *o, double x, struct err *e)
{
    if (!(x > 0) || x > 1)
        return err_set(e, ERR_USAGE,
                       "--rates: %g; expected loads above 0 and up to 1 flit per node and cycle",
                       x);
    if (o->nrate == LOAD_MOST_RATES)
        return err_set(e, ERR_USAGE, "--rates: more than %d loads", LOAD_MOST_RATES);
    o->rate[o->nrate++] = x;
    return true;
}

/* "LOW:HIGH" or "LOW:HIGH:STEP"; HIGH is always among them. */
static bool add_range(struct load_options *o, const char *text, struct arena *a, struct err *e)
{
    char *copy = arena_text(a, text), *rest = strchr(copy, ':'), *third;
    double low, high, step = 0;
    *rest++ = '\0';
    if ((third = strchr(rest, ':')) != NULL) *third++ = '\0';
    if (!number_of(copy, &low) || !number_of(rest, &high) || (third && !number_of(third, &step)) ||
        high < low || (third && !(step > 0)))
        return err_set(e, ERR_USAGE, "--rates: '%.80s'; expected LOW:HIGH, LOW:HIGH:STEP or a list",
                       text);
    /* without a step, POINTS loads with both ends among them */
    if (!third) step = (high - low) / (POINTS - 1);
    /* by numbers, not by sums: the last one is HIGH itself */
    /* a step that fits up to rounding reaches HIGH */
    const double count = step > 0 ? floor((high - low) / step + 1e-9) : 0;
    if (count >= LOAD_MOST_RATES)
        return err_set(e, ERR_USAGE, "--rates: more than %d loads", LOAD_MOST_RATES);
    for (int i = 0; i <= (int)count; i++)
        if (!add_rate(o, fmin(low + i * step, high), e)) return false;
    return low + count * step >= high - 1e-9 * high || add_rate(o, high, e);
}

/* Ranges and numbers, mixed; sorted, each once. */
static bool rates_of(struct load_options *o, const char *text, struct arena *a, struct err *e)
{
    /* words first, so that a comma too many is told before a number */
    const char *word[LOAD_MOST_RATES];
    int n, kept = 0;
    double x;
    if (!split("--rates", text, word, &n, LOAD_MOST_RATES, a, e)) return false;
    for (int i = 0; i < n; i++) {
        bool range = strchr(word[i], ':') != NULL;
        if (!range && !number_of(word[i], &x))
            return err_set(e, ERR_USAGE, "--rates: '%.80s' is not a number", word[i]);
        if (range ? !add_range(o, word[i], a, e) : !add_rate(o, x, e)) return false;
    }
    sort_numbers(o->rate, (size_t)o->nrate);
    for (int i = 0; i < o->nrate; i++)
        if (i == 0 || o->rate[i] > o->rate[kept - 1] * (1 + 1e-9)) o->rate[kept++] = o->rate[i];
    /* a load that was named twice is one point, also where a range has rounded it */
    o->nrate = kept;
    return true;
}

/* A whole number in low .. high of option `name`; `otherwise` without it. */
static bool whole(int *argc, char **argv, const char *name, long low, long high, long otherwise,
                  long *x, struct err *e)
{
    const char *text = take_value(argc, argv, name);
    char *end;
    *x = otherwise;
    if (!text) return true;
    *x = strtol(text, &end, 10);
    if (end != text && *end == '\0' && *x >= low && *x <= high) return true;
    return err_set(e, ERR_USAGE, "%s: '%.40s'; expected a whole number from %ld to %ld", name, text,
                   low, high);
}

/* "64 B" or "4 KiB"; a message must have a size. */
static bool size_of(const char *text, int64_t *bytes, struct err *e)
{
    double x = 0;
    char why[160] = "";
    *bytes = LOAD_BYTES;
    if (!text) return true;
    if (!units_parse(text, UNIT_BYTES, &x, why, sizeof why))
        return err_set(e, ERR_USAGE, "--size: '%.40s': %s", text, why);
    if (x < 1 || x > 1 << 30 || x != floor(x))
        return err_set(e, ERR_USAGE, "--size: '%.40s'; expected 1 B to 1 GiB", text);
    *bytes = (int64_t)x;
    return true;
}

/* "2%" or 0.02: half the interval over the mean. */
static bool within_of(const char *text, double *within, struct err *e)
{
    char *end;
    *within = 0.02;
    if (!text) return true;
    *within = strtod(text, &end);
    /* 2% and 0.02 mean the same */
    bool number = end != text;
    if (number && *end == '%') *within /= 100, end++;
    if (number && *end == '\0' && *within > 0 && *within < 1) return true;
    return err_set(e, ERR_USAGE, "--within: '%.40s'; expected an error such as 2%%", text);
}

/* All options are taken out before any is judged: argp must not meet them. */
bool load_options_take(int *argc, char **argv, struct load_options *o, struct arena *a,
                       struct err *e)
{
    *o = (struct load_options){.saturation = !take_flag(argc, argv, "--no-saturation"),
                               .software = take_flag(argc, argv, "--software")};
    const char *traffic = take_value(argc, argv, "--traffic"),
               *routing = take_value(argc, argv, "--routing"),
               *rates = take_value(argc, argv, "--rates"), *size = take_value(argc, argv, "--size"),
               *within = take_value(argc, argv, "--within");
    /* as the words stand on the command line; defaults below */
    long seed, most;
    if (!whole(argc, argv, "--seed", 0, 1000000000, 1, &seed, e) ||
        !whole(argc, argv, "--messages", LOAD_LEAST_MESSAGES, LOAD_MOST_MESSAGES, DEFAULT_MESSAGES,
               &most, e))
        return false;
    o->sized = size != NULL;
    o->seed = (uint64_t)seed;
    o->most = (int)most;
    return split("--traffic", traffic ? traffic : "uniform", o->traffic, &o->ntraffic,
                 LOAD_MOST_WORDS, a, e) &&
           (!routing ||
            split("--routing", routing, o->routing, &o->nrouting, LOAD_MOST_WORDS, a, e)) &&
           rates_of(o, rates ? rates : "0.05:1:0.05", a, e) && size_of(size, &o->bytes, e) &&
           within_of(within, &o->within, e);
}

bool load_options_levels(const char *text, struct load_options *o, struct arena *a, struct err *e)
{
    const char *word[LEVELS];
    if (!text) return true;
    /* each level once or several times: curves of equal name are one curve */
    if (!split("--level", text, word, &o->nlevel, LEVELS, a, e)) return false;
    for (int i = 0; i < o->nlevel; i++)
        if (!level_named("--level: ", word[i], &o->level[i], e)) return false;
    return true;
}
