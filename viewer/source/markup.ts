/** Text with *italics*, _{subscripts} and ^{superscripts}, as reports write it; a backslash before what is meant literally. */
export function marked(text: string): DocumentFragment {
  const fragment = document.createDocumentFragment();
  const tags: Record<string, string> = { "*": "i", _: "sub", "^": "sup" };
  let plain = "";
  const finish = () => {
    if (plain) fragment.append(plain);
    plain = "";
  };
  for (let at = 0; at < text.length; at++) {
    const letter = text[at];
    if (letter === "\\") {
      plain += text[++at] ?? "";
      continue;
    }
    const begin = letter === "*" ? at + 1 : text[at + 1] === "{" ? at + 2 : at + 1;
    const end = letter === "*" ? text.indexOf("*", begin) : text[at + 1] === "{" ? text.indexOf("}", begin) : begin + 1;
    if (!(letter in tags) || end < begin || begin >= text.length) {
      plain += letter;
      continue;
    }
    finish();
    const element = document.createElement(tags[letter]);
    element.append(marked(text.slice(begin, end)));
    fragment.append(element);
    at = letter === "*" || text[at + 1] === "{" ? end : begin;
  }
  finish();
  return fragment;
}
