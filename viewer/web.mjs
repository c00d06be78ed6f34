// Makes target/web/index.html of the viewer's page and of front.html, which is around it: node web.mjs [SOURCE], the address of
// the source for its link.
import { existsSync, readFileSync, writeFileSync } from "node:fs";

const from = (path) => readFileSync(new URL(path, import.meta.url), "utf8");
const [source] = process.argv.slice(2);
// What the server says in a header, the page says itself.
const policy =
  "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src 'self'; connect-src 'self'; " +
  "img-src 'self' data: blob:; base-uri 'none'; form-action 'none'";
const book = existsSync(new URL("../target/web/book/index.html", import.meta.url));
const links = [
  book && ["book/index.html", "The book"],
  ...(book ? [["book/start/first-transition.html", "Begin"], ["book/guides/python.html", "From Python"], ["book/results/claims.html", "What came out"]]
    : [["README.md", "What it is"], ["python.md", "From Python"], ["VALIDATION.md", "What came out"]]),
  ["https://doi.org/10.1103/PhysRevE.85.031302", "The paper"], ["CITATION.cff", "Cite it"],
  source && [source, "Source"], ["LICENSE-MIT", "MIT or Apache-2.0"], ["THIRD-PARTY.txt", "Works of others"],
].filter(Boolean);
const nav = links.map(([address, name]) => `<a href="${address}">${name}</a>`).join("\n    ");

let page = from("../crates/viewer/assets/tube.html")
  .replace("<body>", '<body data-engine="page">')
  .replace("<title>peristalsis</title>", "<title>Peristalsis of grains – a tube that jams and remembers</title>")
  .replace('<meta charset="utf-8">', `$&\n<meta http-equiv="Content-Security-Policy" content="${policy}">`);
const parts = from("front.html").replace("REPOSITORY_LINKS", `\n    ${nav}\n  `).split(/^<!--(\w+)-->\n/m);
for (let k = 1; k < parts.length; k += 2) page = page.replace(`<!--${parts[k]}-->`, () => parts[k + 1].trimEnd());
// Its first heading is the front page's own.
page = page.replace('<h1 id="title">peristalsis</h1>', '<h2 id="title">peristalsis</h2>');
writeFileSync(new URL("../target/web/index.html", import.meta.url), page);
