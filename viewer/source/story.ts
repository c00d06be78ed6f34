import { element } from "./page";

/** A chapter of the front page. */
export type Chapter = "jams" | "remembers" | "friction" | "begins";

/** The buttons of the chapters, where the page has them; what each does. */
export function listenToChapters(act: (chapter: Chapter) => void): void {
  for (const button of document.querySelectorAll<HTMLButtonElement>("[data-chapter]"))
    button.onclick = () => {
      for (const card of document.querySelectorAll(".chapter")) {
        card.classList.toggle("now", card.contains(button));
        card.querySelector(".said")?.replaceChildren();
      }
      act(button.dataset.chapter as Chapter);
    };
}

/** What has come out, in the card of the chapter that goes on. */
export function tell(text: string): void {
  const said = document.querySelector(".chapter.now .said");
  if (said && said.textContent !== text) said.textContent = text;
}

/** Asks before what came after a time is given up, which nobody can bring back. */
export function givesUp(period: number, newest: number, unit: string, question: string, answer: string): Promise<boolean> {
  const dialog = element<HTMLDialogElement>("confirm");
  element("confirm-text").textContent =
    `${question} What came after ${period.toFixed(2)} ${unit}, up to ${newest.toFixed(2)} ${unit}, is given up: the loop and the frames.`;
  element("confirm-yes").textContent = answer;
  dialog.returnValue = "";
  dialog.showModal();
  return new Promise((done) => dialog.addEventListener("close", () => done(dialog.returnValue === "yes"), { once: true }));
}
