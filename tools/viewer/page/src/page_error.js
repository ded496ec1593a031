/// Something wrong with the page's data or the browser, said in a sentence that the page shows.
export class PageError extends Error {}
