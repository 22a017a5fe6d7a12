/* field_segments.c - lists of mappings whose values are fields of struct software_segment
 * (field_segments.h).
 *
 *     list = [ segment, .. ]      segment = { key: value, .. }      keys: the rows below
 *
 * The text has this form wherever it comes from: files, command line, store. At most
 * SOFTWARE_MAX_SEGMENTS segments. */
#include "spec/field_segments.h"

#include <ctype.h>
#include <string.h>

#include "spec/field_list.h"
#include "spec/machine_spec.h"

/* Longer words cannot be right: they are refused before they are compared. */
enum { KEY_LENGTH = 32, VALUE_LENGTH = 64 };

#define AT(member) .offset = offsetof(struct software_segment, member)

/* In the order of enum protocol. */
static const char *const protocols[] = {"eager", "rendezvous", "synchronous", NULL};
static const char expected[] = "expected a list of segments such as '[{from: 0 B, send.overhead: 1 "
                               "us}, {from: 8 KiB, protocol: rendezvous}]'";

/* Names and bounds are those of the keys of software.* that a segment takes the place of. */
static const struct field rows[] = {
    {.key = "from", .kind = FIELD_INT64, .unit = UNIT_BYTES, AT(from), .min = 0, .max = 1e15},
    {.key = "send.overhead",
     .kind = FIELD_REAL,
     .unit = UNIT_TIME,
     AT(send_overhead),
     .min = 0,
     .max = 10},
    {.key = "send.copy",
     .kind = FIELD_REAL,
     .unit = UNIT_TIME_PER_BYTE,
     AT(send_copy),
     .min = 0,
     .max = 1},
    {.key = "recv.overhead",
     .kind = FIELD_REAL,
     .unit = UNIT_TIME,
     AT(recv_overhead),
     .min = 0,
     .max = 10},
    {.key = "recv.copy",
     .kind = FIELD_REAL,
     .unit = UNIT_TIME_PER_BYTE,
     AT(recv_copy),
     .min = 0,
     .max = 1},
    {.key = "latency", .kind = FIELD_REAL, .unit = UNIT_TIME, AT(latency), .min = 0, .max = 10},
    {.key = "gap", .kind = FIELD_REAL, .unit = UNIT_TIME, AT(gap), .min = 0, .max = 10},
    {.key = "gap_per_byte",
     .kind = FIELD_REAL,
     .unit = UNIT_TIME_PER_BYTE,
     AT(gap_per_byte),
     .min = 0,
     .max = 1},
    {.key = "protocol", .kind = FIELD_CHOICE, .choice = protocols, AT(protocol)},
    {.key = "rendezvous.latency",
     .kind = FIELD_REAL,
     .unit = UNIT_TIME,
     AT(rendezvous_latency),
     .min = 0,
     .max = 10},
};

enum { NROW = sizeof rows / sizeof *rows };

/* Line ends count as blanks: a list may stand over several lines. */
static const char *skip_blanks(const char *s)
{
    while (isspace((unsigned char)*s)) s++;
    return s;
}

/* Up to one of `stops`, without blanks at the ends; returns where it stopped, NULL when it does not
 * fit. Never allocates: a list is read in place. */
static const char *take_word(const char *s, const char *stops, char *word, size_t size)
{
    s = skip_blanks(s);
    size_t n = strcspn(s, stops);
    const char *end = s + n;
    while (n > 0 && isspace((unsigned char)s[n - 1])) n--;
    if (n >= size) return NULL;
    memcpy(word, s, n);
    word[n] = '\0';
    return end;
}

/* Ten rows: searched from the front. NROW: unknown. */
static int row_of(const char *key)
{
    int i = 0;
    while (i < NROW && strcmp(rows[i].key, key) != 0) i++;
    return i;
}

/* The nearest key if there is one, else all of them. */
static bool refuse_key(int number, const char *key, char *why, int size)
{
    const char *name[NROW];
    for (int i = 0; i < NROW; i++) name[i] = rows[i].key;
    const char *near = text_nearest(key, name, NROW);
    if (near)
        return field_refuse(why, size, "segment %d: unknown key '%s'; did you mean '%s'?", number,
                            key, near);
    int at =
        snprintf(why, (size_t)size, "segment %d: unknown key '%s'; expected one of", number, key);
    /* All keys, since none is near. */
    for (int i = 0; i < NROW && at < size; i++)
        at += snprintf(why + at, (size_t)(size - at), "%s %s", i > 0 ? "," : "", name[i]);
    return false;
}

/* "key: value" at s, which `seen` has not met yet; returns where it ends, NULL when refused. The
 * segment's number stands in every message: lists have up to eight of them. */
static const char *take_entry(const char *s, int number, bool seen[NROW],
                              struct software_segment *out, field_reader *read, struct arena *a,
                              char *why, int size)
{
    char key[KEY_LENGTH], value[VALUE_LENGTH], clause[256];
    const char *at = take_word(s, ":,}", key, sizeof key);
    if (at == NULL || *at != ':')
        return field_refuse(why, size, "segment %d: %s", number, expected), NULL;
    /* A value ends at a comma or at the closing brace. */
    at = take_word(at + 1, ",}", value, sizeof value);
    if (at == NULL || *at == '\0')
        return field_refuse(why, size, "segment %d: %s", number, expected), NULL;
    /* Values are read by the rows' own reader, with units and ranges as everywhere else. */
    const int row = row_of(key);
    if (row == NROW) return refuse_key(number, key, why, size), NULL;
    if (seen[row])
        return field_refuse(why, size, "segment %d: '%s' is given twice", number, key), NULL;
    seen[row] = true;
    if (!read(&rows[row], out, value, a, clause, (int)sizeof clause))
        return field_refuse(why, size, "segment %d: %s '%s': %s", number, key, value, clause), NULL;
    return *at == ',' ? at + 1 : at;
}

/* "{...}" at s; returns where it ends, NULL when refused. -1 says "not given": then the value of
 * `software` holds (software_spec.c). */
static const char *take_segment(const char *s, int number, struct software_segment *out,
                                field_reader *read, struct arena *a, char *why, int size)
{
    bool seen[NROW] = {false};
    memset(out, 0, sizeof *out);
    *out = (struct software_segment){.send_overhead = -1,
                                     .send_copy = -1,
                                     .recv_overhead = -1,
                                     .recv_copy = -1,
                                     .latency = -1,
                                     .gap = -1,
                                     .gap_per_byte = -1,
                                     .rendezvous_latency = -1};
    /* Entry by entry; take_entry steps over the commas. */
    if (*s != '{') return field_refuse(why, size, "%s", expected), NULL;
    for (s = skip_blanks(s + 1); *s != '}'; s = skip_blanks(s))
        if ((s = take_entry(s, number, seen, out, read, a, why, size)) == NULL) return NULL;
    /* Row 0 is `from`: a segment without a size would be none. */
    if (!seen[0])
        return field_refuse(why, size, "segment %d has no 'from'; expected its smallest message",
                            number),
               NULL;
    /* A handshake's latency without a handshake is a misunderstanding. */
    if (seen[NROW - 1] && out->protocol == PROTOCOL_EAGER)
        return field_refuse(why, size,
                            "segment %d: rendezvous.latency of an eager segment; expected "
                            "'protocol: rendezvous' or 'protocol: synchronous' beside it",
                            number),
               NULL;
    return s + 1;
}

/* The first from 0 B, each from more than the one before. Called after each segment, so that the
 * first wrong one is named. */
static bool in_order(const struct software_segment *list, int n, char *why, int size)
{
    const long long from = (long long)list[n - 1].from,
                    before = n > 1 ? (long long)list[n - 2].from : 0;
    if (n == 1 && from != 0)
        return field_refuse(why, size, "the first segment begins at %lld B; expected one from 0 B",
                            from);
    if (n > 1 && from == before)
        return field_refuse(why, size, "segments %d and %d both begin at %lld B", n - 1, n, from);
    if (n > 1 && from < before)
        return field_refuse(
            why, size, "segment %d begins at %lld B, after one from %lld B; expected rising sizes",
            n, from, before);
    return true;
}

/* Into a copy: a list that is refused leaves the struct as it was. `read` is field_set, passed down
 * because field.c calls this file. */
bool field_segments_set(const struct field *f, void *base, const char *text, field_reader *read,
                        struct arena *a, char *why, int size)
{
    struct software_segment list[SOFTWARE_MAX_SEGMENTS];
    int n = 0;
    memset(list, 0, sizeof list);
    const char *s = skip_blanks(text);
    if (*s != '[') return field_refuse(why, size, "%s", expected);
    for (s = skip_blanks(s + 1); *s != ']' && *s != '\0'; s = skip_blanks(s)) {
        /* Refused before the ninth is read. */
        if (n == f->capacity || n == SOFTWARE_MAX_SEGMENTS)
            return field_refuse(why, size, "more than %d segments", SOFTWARE_MAX_SEGMENTS);
        /* Numbered from 1, as a person counts. */
        s = take_segment(s, n + 1, &list[n], read, a, why, size);
        if (s == NULL || !in_order(list, ++n, why, size)) return false;
        s = skip_blanks(s);
        if (*s != ',' && *s != ']') return field_refuse(why, size, "%s", expected);
        if (*s == ',') s++;
    }
    if (*s != ']' || *skip_blanks(s + 1) != '\0')
        return field_refuse(why, size, "brackets do not match; %s", expected);
    /* All or nothing. */
    memcpy((char *)base + f->offset, list, sizeof list);
    *(int *)(void *)((char *)base + f->count) = n;
    return true;
}

/* What was not given is not printed, so that the text reads back to the same segment. */
static void print_segment(const struct software_segment *s, field_printer *print, struct text *out)
{
    text_add(out, "{");
    for (int i = 0; i < NROW; i++) {
        const char *place = (const char *)s + rows[i].offset;
        /* Not given, or the protocol that needs no word. */
        if (rows[i].kind == FIELD_REAL && *(const double *)(const void *)place < 0) continue;
        if (rows[i].kind == FIELD_CHOICE && s->protocol == PROTOCOL_EAGER) continue;
        text_add(out, "%s%s: ", i > 0 ? ", " : "", rows[i].key);
        print(&rows[i], s, out);
    }
    text_add(out, "}");
}

void field_segments_print(const struct field *f, const void *base, field_printer *print,
                          struct text *out)
{
    const struct software_segment *list =
        (const struct software_segment *)(const void *)((const char *)base + f->offset);
    const int n = *(const int *)(const void *)((const char *)base + f->count);
    text_add(out, "[");
    for (int i = 0; i < n; i++) {
        if (i > 0) text_add(out, ", ");
        print_segment(&list[i], print, out);
    }
    text_add(out, "]");
}
