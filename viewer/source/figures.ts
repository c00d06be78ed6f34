import { marked } from "./markup";
import type { List } from "./messages";

/** The figures of a reproduction, each with what it says and the studies behind it. */
export function showFigures(box: HTMLElement, list: List, open: (study: number) => void): void {
  box.replaceChildren(
    ...list.figures.map(({ claim, title, verdict, caption, studies }, number) => {
      const card = document.createElement("article");
      const head = document.createElement("h2");
      head.append(`${claim} `, marked(title));
      const said = document.createElement("p");
      said.className = "verdict";
      said.dataset.verdict = verdict;
      said.textContent = verdict;
      const link = document.createElement("a");
      link.href = `figure/${number}`;
      const picture = document.createElement("img");
      picture.src = `figure/${number}`;
      picture.loading = "lazy";
      picture.alt = caption.replaceAll(/[*_^{}\\]/g, "");
      link.append(picture);
      const text = document.createElement("p");
      text.append(marked(caption));
      const behind = document.createElement("div");
      behind.className = "behind";
      for (const name of studies) {
        const study = list.studies.findIndex((it) => it.name === name);
        if (study < 0) continue;
        const button = document.createElement("button");
        button.textContent = name;
        button.onclick = () => open(study);
        behind.append(button);
      }
      card.append(head, said, link, text, behind);
      return card;
    }),
  );
}
