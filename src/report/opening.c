/* opening.c - abstract and glossary of the report on the paper; see opening.h.
 *
 * Their texts are queries in plots/: abstract.sql makes sentences, verdicts.sql and glossary.sql
 * tables. So a number in a sentence cannot differ from the one in the table. */
#include "report/opening.h"

#include "base/text.h"

/* The query data_dir/plots/NAME.sql. */
static bool read_query(const char *data_dir, const char *name, struct text *sql, struct err *e)
{
    struct text path = {0};
    text_add(&path, "%s/plots/%s.sql", data_dir, name);
    bool ok = text_read_file(sql, path.s, e);
    /* never NULL: an empty file is an empty query */
    text_add(sql, "%s", "");
    text_free(&path);
    return ok;
}

/* One paragraph per row: the sentences are made in SQL, from the numbers. */
static bool tell_paragraph(void *context, int ncolumn, const char *const *name,
                           const char *const *value)
{
    (void)ncolumn;
    (void)name;
    page_paragraph(context, value[0] ? value[0] : "");
    return true;
}

/* The rows of plots/NAME.sql as a table. */
static bool put_table(struct page *p, struct store *s, const char *data_dir, const char *name,
                      struct err *e)
{
    struct text sql = {0};
    bool ok =
        read_query(data_dir, name, &sql, e) && page_table(p, s, sql.s, 0, NULL, "Nothing.", e);
    text_free(&sql);
    return ok;
}

/* What a reader wants to know first: the findings in words, then the verdicts. */
bool opening_abstract(struct page *p, struct store *s, const char *data_dir, struct err *e)
{
    struct text sql = {0};
    page_heading(p, 2, "Abstract");
    bool ok = read_query(data_dir, "abstract", &sql, e) &&
              store_select(s, sql.s, 0, NULL, tell_paragraph, p, e);
    text_free(&sql);
    return ok && put_table(p, s, data_dir, "verdicts", e);
}

/* At the end: a reader looks there for a word, and does not begin with it. */
bool opening_glossary(struct page *p, struct store *s, const char *data_dir, struct err *e)
{
    page_heading(p, 2, "Glossary");
    return put_table(p, s, data_dir, "glossary", e);
}
